#include "daemons/lidar_cone_detector/ground.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hairpin {

Ground::Ground(const GroundParams& params)
    : params_(params), grid_(params.grid), lines_(params.lines, grid_) {}

const std::vector<float>& Ground::Fit(const PointCloud& cloud) {
  grid_.Fill(cloud);
  plane_ = FitGroundPlane(grid_, params_.plane);
  lines_.Fit(grid_, plane_);
  height_.resize(cloud.size());
  for (size_t i = 0; i < cloud.size(); ++i) {
    height_[i] = cloud.z[i] - plane_.At(cloud.x[i], cloud.y[i]) -
                 Residual(grid_.bearing()[i], grid_.range()[i]);
  }
  return height_;
}

float Ground::HeightAt(float x, float y) const {
  const float bearing =
      (FastBearing(y, x) + std::numbers::pi_v<float>)*static_cast<float>(grid_.sectors()) /
      (2.0f * std::numbers::pi_v<float>);
  return plane_.At(x, y) + Residual(bearing, std::sqrt(x * x + y * y));
}

// Bilinear between the middles of two sectors and the edges of a bin.
inline float Ground::Residual(float bearing, float range) const {
  const int sectors = grid_.sectors();
  const float shifted = bearing + static_cast<float>(sectors) - 0.5f;
  const int whole = static_cast<int>(shifted);
  const float across = shifted - static_cast<float>(whole);
  const int left =
      whole >= sectors ? (whole >= 2 * sectors ? whole - 2 * sectors : whole - sectors) : whole;
  const int right = left + 1 == sectors ? 0 : left + 1;
  const float radial =
      std::min(range / grid_.bin_length(), static_cast<float>(grid_.bins()) - 0.001f);
  const int bin = static_cast<int>(radial);
  const float along = radial - static_cast<float>(bin);
  const float* a = lines_.row(left) + bin;
  const float* b = lines_.row(right) + bin;
  const float at_left = a[0] + along * (a[1] - a[0]);
  const float at_right = b[0] + along * (b[1] - b[0]);
  return at_left + across * (at_right - at_left);
}

}  // namespace hairpin
