#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "daemons/lidar_cone_detector/point_cloud.hpp"

namespace hairpin {

struct PolarGridParams {
  int sectors = 0;
  double bin_length = 0.0;  // radial [m]
  double max_range = 0.0;   // from base; points beyond take no part [m]
};

/// Points sorted into angular sectors and radial bins about base, the lowest point kept of each
/// cell.
class PolarGrid {
 public:
  static constexpr float kEmpty = std::numeric_limits<float>::infinity();

  /// Throws std::invalid_argument where a parameter cannot be.
  explicit PolarGrid(const PolarGridParams& params);
  void Fill(const PointCloud& cloud);

  int sectors() const { return sectors_; }
  int bins() const { return bins_; }
  float bin_length() const { return bin_length_; }
  size_t Cell(int sector, int bin) const {
    return static_cast<size_t>(sector) * static_cast<size_t>(bins_) + static_cast<size_t>(bin);
  }
  /// Height [m] and range [m] of a cell's lowest point; height kEmpty where it has none.
  float lowest(size_t cell) const { return lowest_[cell]; }
  float lowest_range(size_t cell) const { return lowest_range_[cell]; }
  /// Direction of a sector's middle: cosine and sine of its bearing.
  float cosine(int sector) const { return cosine_[static_cast<size_t>(sector)]; }
  float sine(int sector) const { return sine_[static_cast<size_t>(sector)]; }

  /// For each point of the cloud: its bearing in sectors, from 0 at -pi to sectors() at pi, and its
  /// range [m].
  const std::vector<float>& bearing() const { return bearing_; }
  const std::vector<float>& range() const { return range_; }

 private:
  int sectors_;
  int bins_;
  float bin_length_;
  std::vector<float> lowest_, lowest_range_, cosine_, sine_, bearing_, range_;
};

/// Arc tangent of y/x in (-pi, pi], within 1e-5 rad: a minimax polynomial without a branch, for
/// loops that the compiler vectorizes. 0 for (0, 0).
inline float FastBearing(float y, float x) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const float ax = std::abs(x);
  const float ay = std::abs(y);
  const float t = std::min(ax, ay) / std::max(std::max(ax, ay), 1e-20f);
  // Odd polynomial for atan on [0, 1] (Abramowitz and Stegun 4.4.49, 1964): error below 1e-5.
  const float u = t * t;
  float angle =
      t * (0.9998660f + u * (-0.3302995f + u * (0.1801410f + u * (-0.0851330f + u * 0.0208351f))));
  angle = ay > ax ? 0.5f * kPi - angle : angle;
  angle = x < 0.0f ? kPi - angle : angle;
  return std::copysign(angle, y);
}

}  // namespace hairpin
