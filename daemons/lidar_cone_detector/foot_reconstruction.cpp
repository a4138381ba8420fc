#include "daemons/lidar_cone_detector/foot_reconstruction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr float kCellSide = 0.15f;  // m

}  // namespace

FootReconstruction::FootReconstruction(double radius, double half_extent)
    : radius_(static_cast<float>(radius)),
      half_extent_(static_cast<float>(half_extent)),
      per_metre_(1.0f / kCellSide) {
  if (!(radius > 0.0 && radius < 2.0))
    throw std::invalid_argument("FootReconstruction: radius must be in (0, 2)");
  if (!(half_extent > 0.0 && half_extent < 300.0))
    throw std::invalid_argument("FootReconstruction: half_extent must be in (0, 300)");
  width_ = static_cast<size_t>(std::ceil(2.0f * half_extent_ * per_metre_)) + 1;
  count_.resize(width_ * width_);
  nearby_.resize(width_ * width_ * kPerCell);
}

inline size_t FootReconstruction::CellOf(float x, float y) const {
  const auto column = static_cast<size_t>((x + half_extent_) * per_metre_);
  const auto row = static_cast<size_t>((y + half_extent_) * per_metre_);
  return row * width_ + column;
}

void FootReconstruction::Mark(std::span<const Eigen::Vector2f> centres) {
  const size_t last =
      std::min(centres.size(), static_cast<size_t>(std::numeric_limits<uint16_t>::max()));
  for (size_t k = 0; k < last; ++k) {
    const auto clamped = [this](float value) {
      return std::clamp(value, -half_extent_, half_extent_);
    };
    const size_t low = CellOf(clamped(centres[k].x() - radius_), clamped(centres[k].y() - radius_));
    const size_t high =
        CellOf(clamped(centres[k].x() + radius_), clamped(centres[k].y() + radius_));
    for (size_t row = low / width_; row <= high / width_; ++row) {
      for (size_t column = low % width_; column <= high % width_; ++column) {
        const size_t cell = row * width_ + column;
        if (count_[cell] == 0) marked_.push_back(cell);
        if (count_[cell] == kPerCell) continue;
        nearby_[cell * kPerCell + count_[cell]++] = static_cast<uint16_t>(k);
      }
    }
  }
}

const Clusters& FootReconstruction::Run(const PointCloud& cloud, const std::vector<float>& height,
                                        std::span<const Eigen::Vector2f> centres, float min_height,
                                        float max_height) {
  Mark(centres);
  hits_.clear();
  clusters_.begin.assign(centres.size() + 1, 0);
  for (size_t i = 0; i < cloud.size(); ++i) {
    if (!(height[i] >= min_height && height[i] <= max_height)) continue;
    if (!(std::abs(cloud.x[i]) < half_extent_ && std::abs(cloud.y[i]) < half_extent_)) continue;
    const size_t cell = CellOf(cloud.x[i], cloud.y[i]);
    if (count_[cell] == 0) continue;
    float nearest = radius_ * radius_;
    size_t centre = centres.size();
    for (size_t k = 0; k < count_[cell]; ++k) {
      const size_t candidate = nearby_[cell * kPerCell + k];
      const float dx = cloud.x[i] - centres[candidate].x();
      const float dy = cloud.y[i] - centres[candidate].y();
      if (dx * dx + dy * dy >= nearest) continue;
      nearest = dx * dx + dy * dy;
      centre = candidate;
    }
    if (centre == centres.size()) continue;
    hits_.push_back({static_cast<uint32_t>(i), static_cast<uint32_t>(centre)});
    ++clusters_.begin[centre + 1];
  }
  for (size_t k = 0; k < centres.size(); ++k) clusters_.begin[k + 1] += clusters_.begin[k];
  cursor_.assign(clusters_.begin.begin(), clusters_.begin.end());
  clusters_.points.resize(hits_.size());
  for (const Hit& hit : hits_) clusters_.points[cursor_[hit.centre]++] = hit.point;
  for (const size_t cell : marked_) count_[cell] = 0;
  marked_.clear();
  return clusters_;
}

}  // namespace hairpin
