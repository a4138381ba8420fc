#include "daemons/lidar_cone_detector/intensity_image.hpp"

#include <algorithm>
#include <cmath>

namespace hairpin {
namespace {

constexpr float kExtent = 0.56f;       // m: a large cone, 0.505, with noise
constexpr float kReach = 2.5f;         // pixels that a return is spread over, each way
constexpr float kMaxIntensity = 1.5f;  // retro-reflectors say no more than "very bright"
constexpr size_t kPlane = kImagePixels;

// Epanechnikov's kernel: a parabola, 0 from kReach on.
float Kernel(float distance) {
  const float share = distance / kReach;
  return std::max(0.0f, 1.0f - share * share);
}

void Spread(float column, float row, float intensity, IntensityImage& image) {
  const int first_column = std::max(0, static_cast<int>(std::ceil(column - kReach)));
  const int last_column = std::min(kImageSize - 1, static_cast<int>(std::floor(column + kReach)));
  const int first_row = std::max(0, static_cast<int>(std::ceil(row - kReach)));
  const int last_row = std::min(kImageSize - 1, static_cast<int>(std::floor(row + kReach)));
  for (int r = first_row; r <= last_row; ++r) {
    const float vertical = Kernel(static_cast<float>(r) - row);
    for (int c = first_column; c <= last_column; ++c) {
      const float weight = vertical * Kernel(static_cast<float>(c) - column);
      const auto pixel = static_cast<size_t>(r * kImageSize + c);
      image[pixel] += weight * intensity;
      image[kPlane + pixel] += weight;
    }
  }
}

}  // namespace

IntensityImage RenderIntensity(const ConeReturns& cone, float percent_per_step) {
  IntensityImage image{};
  const Eigen::Vector2f sight = cone.axis.normalized();
  constexpr float kPixelsPerMetre = kImageSize / kExtent;
  for (size_t i = 0; i < cone.x.size(); ++i) {
    const Eigen::Vector2f offset(cone.x[i] - cone.axis.x(), cone.y[i] - cone.axis.y());
    const float right = sight.y() * offset.x() - sight.x() * offset.y();
    const float column = (right / kExtent + 0.5f) * kImageSize - 0.5f;
    const float row = cone.z[i] * kPixelsPerMetre - 0.5f;
    const float intensity = 0.01f * percent_per_step * static_cast<float>(cone.intensity[i]);
    if (std::abs(column) > 2.0f * kImageSize || std::abs(row) > 2.0f * kImageSize) continue;
    Spread(column, row, std::min(intensity, kMaxIntensity), image);
  }
  for (size_t pixel = 0; pixel < kPlane; ++pixel) {
    float& coverage = image[kPlane + pixel];
    if (coverage <= 0.0f) continue;
    const float mean = image[pixel] / coverage;
    coverage = std::min(coverage, 1.0f);
    image[pixel] = mean * coverage;
  }
  return image;
}

}  // namespace hairpin
