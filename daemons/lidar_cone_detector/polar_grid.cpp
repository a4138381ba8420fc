#include "daemons/lidar_cone_detector/polar_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace

PolarGrid::PolarGrid(const PolarGridParams& params)
    : sectors_(params.sectors),
      bins_(static_cast<int>(std::ceil(params.max_range / params.bin_length))),
      bin_length_(static_cast<float>(params.bin_length)) {
  if (params.sectors < 8 || params.sectors > 2048)
    throw std::invalid_argument("PolarGrid: sectors must be 8 to 2048");
  if (!(params.bin_length > 0.0) || !(params.max_range >= 2.0 * params.bin_length) || bins_ > 4096)
    throw std::invalid_argument("PolarGrid: max_range must be 2 to 4096 bin lengths");
  const size_t cells = static_cast<size_t>(sectors_) * static_cast<size_t>(bins_);
  lowest_.resize(cells);
  lowest_range_.resize(cells);
  for (int sector = 0; sector < sectors_; ++sector) {
    const double bearing = -std::numbers::pi + 2.0 * std::numbers::pi * (sector + 0.5) / sectors_;
    cosine_.push_back(static_cast<float>(std::cos(bearing)));
    sine_.push_back(static_cast<float>(std::sin(bearing)));
  }
}

void PolarGrid::Fill(const PointCloud& cloud) {
  const size_t n = cloud.size();
  bearing_.resize(n);
  range_.resize(n);
  const float per_radian = static_cast<float>(sectors_) / (2.0f * kPi);
  for (size_t i = 0; i < n; ++i) {
    bearing_[i] = (FastBearing(cloud.y[i], cloud.x[i]) + kPi) * per_radian;
    range_[i] = std::sqrt(cloud.x[i] * cloud.x[i] + cloud.y[i] * cloud.y[i]);
  }
  std::fill(lowest_.begin(), lowest_.end(), kEmpty);
  const float per_metre = 1.0f / bin_length_;
  for (size_t i = 0; i < n; ++i) {
    const int bin = static_cast<int>(range_[i] * per_metre);
    if (bin >= bins_) continue;
    const size_t cell = Cell(std::min(static_cast<int>(bearing_[i]), sectors_ - 1), bin);
    if (cloud.z[i] >= lowest_[cell]) continue;
    lowest_[cell] = cloud.z[i];
    lowest_range_[cell] = range_[i];
  }
}

}  // namespace hairpin
