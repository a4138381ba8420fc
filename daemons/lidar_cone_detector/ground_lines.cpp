#include "daemons/lidar_cone_detector/ground_lines.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hairpin {
namespace {

// Past its last point a line goes on this far, then level: [m].
constexpr float kExtrapolation = 4.0f;

}  // namespace

GroundLines::GroundLines(const GroundLineParams& params, const PolarGrid& grid)
    : params_(params),
      sectors_(grid.sectors()),
      bins_(grid.bins()),
      bin_length_(grid.bin_length()),
      table_(static_cast<size_t>(sectors_) * static_cast<size_t>(bins_ + 1)),
      known_(static_cast<size_t>(sectors_)) {
  if (!(params.slope_sigma > 0.0) || !(params.height_sigma > 0.0) || !(params.tolerance > 0.0))
    throw std::invalid_argument("GroundLines: slope_sigma, height_sigma, tolerance must be > 0");
  if (params.min_points < 2) throw std::invalid_argument("GroundLines: min_points must be >= 2");
}

void GroundLines::Add(Line& line, const Sample& sample) const {
  const double r = static_cast<double>(sample.range);
  const double h = static_cast<double>(sample.height);
  if (line.n == 0.0) line.first_range = sample.range;
  line.last_range = sample.range;
  line.n += 1.0;
  line.r += r;
  line.h += h;
  line.rr += r * r;
  line.rh += r * h;
  const double prior = std::pow(params_.height_sigma / params_.slope_sigma, 2);
  const double slope =
      (line.rh - line.r * line.h / line.n) / (line.rr - line.r * line.r / line.n + prior);
  line.slope = static_cast<float>(std::clamp(slope, -params_.max_slope, params_.max_slope));
  line.offset = static_cast<float>((line.h - static_cast<double>(line.slope) * line.r) / line.n);
}

bool GroundLines::Extends(const Line& line, const Sample& sample) const {
  return std::abs(sample.height - line.At(sample.range)) <= static_cast<float>(params_.tolerance);
}

void GroundLines::TryPending() {
  if (pending_.size() < static_cast<size_t>(params_.min_points)) return;
  Line line;
  for (const Sample& sample : pending_) {
    if (line.n >= 2.0 && !Extends(line, sample)) break;
    Add(line, sample);
  }
  const auto slope_limit = static_cast<float>(params_.max_slope);
  const bool straight =
      line.n == static_cast<double>(pending_.size()) && std::abs(line.slope) < slope_limit;
  // Ground goes on from where it was, no steeper than ground can be.
  const float gap = std::max(line.first_range - lines_.back().last_range, bin_length_);
  const float step =
      std::abs(line.At(line.first_range) - lines_.back().At(lines_.back().last_range));
  if (straight && step <= slope_limit * gap + static_cast<float>(params_.tolerance)) {
    lines_.push_back(line);
    pending_.clear();
  } else {
    pending_.erase(pending_.begin());
  }
}

void GroundLines::FitSector(const PolarGrid& grid, const GroundPlane& plane, int sector) {
  lines_.clear();
  pending_.clear();
  for (int bin = 0; bin < bins_; ++bin) {
    const size_t cell = grid.Cell(sector, bin);
    if (grid.lowest(cell) == PolarGrid::kEmpty) continue;
    const float range = grid.lowest_range(cell);
    const Sample sample{range, grid.lowest(cell) - plane.At(range * grid.cosine(sector),
                                                            range * grid.sine(sector))};
    if (lines_.empty()) {
      if (std::abs(sample.height) > static_cast<float>(params_.max_start_height)) continue;
      Add(lines_.emplace_back(), sample);
    } else if (Extends(lines_.back(), sample)) {
      Add(lines_.back(), sample);
      pending_.clear();
    } else {
      pending_.push_back(sample);
      TryPending();
    }
  }
}

void GroundLines::WriteRow(int sector) {
  float* row = table_.data() + static_cast<size_t>(sector) * static_cast<size_t>(bins_ + 1);
  size_t line = 0;
  for (int bin = 0; bin <= bins_; ++bin) {
    const float range = static_cast<float>(bin) * bin_length_;
    while (line + 1 < lines_.size() && lines_[line + 1].first_range <= range) ++line;
    const Line& current = lines_[line];
    if (range <= current.last_range || line + 1 == lines_.size()) {
      row[bin] =
          current.At(std::clamp(range, current.first_range, current.last_range + kExtrapolation));
      continue;
    }
    // In the gap between two lines: from the end of one to the start of the next.
    const Line& next = lines_[line + 1];
    const float share = (range - current.last_range) / (next.first_range - current.last_range);
    row[bin] = (1.0f - share) * current.At(current.last_range) + share * next.At(next.first_range);
  }
}

void GroundLines::FillEmptySectors() {
  if (std::find(known_.begin(), known_.end(), 1) == known_.end()) {
    std::fill(table_.begin(), table_.end(), 0.0f);
    return;
  }
  const auto width = static_cast<size_t>(bins_ + 1);
  const auto index = [this](int sector) {
    return static_cast<size_t>((sector + sectors_) % sectors_);
  };
  for (int sector = 0; sector < sectors_; ++sector) {
    if (known_[static_cast<size_t>(sector)]) continue;
    int below = 1, above = 1;
    while (!known_[index(sector - below)]) ++below;
    while (!known_[index(sector + above)]) ++above;
    const float share = static_cast<float>(below) / static_cast<float>(below + above);
    const float* from = table_.data() + index(sector - below) * width;
    const float* to = table_.data() + index(sector + above) * width;
    float* row = table_.data() + static_cast<size_t>(sector) * width;
    for (size_t bin = 0; bin < width; ++bin)
      row[bin] = (1.0f - share) * from[bin] + share * to[bin];
  }
}

void GroundLines::Fit(const PolarGrid& grid, const GroundPlane& plane) {
  for (int sector = 0; sector < sectors_; ++sector) {
    FitSector(grid, plane, sector);
    known_[static_cast<size_t>(sector)] = lines_.empty() ? 0 : 1;
    if (!lines_.empty()) WriteRow(sector);
  }
  FillEmptySectors();
}

}  // namespace hairpin
