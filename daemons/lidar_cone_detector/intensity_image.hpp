#pragma once

#include <array>
#include <cstddef>

#include "daemons/lidar_cone_detector/cone_returns.hpp"

namespace hairpin {

inline constexpr int kImageSize = 32;
inline constexpr size_t kImagePixels = 1024;
/// Two planes of 32 x 32, row 0 at the ground: intensity (1: white diffuse target) where there are
/// returns, and how well each pixel is covered by returns, 0 to 1.
using IntensityImage = std::array<float, 2 * kImagePixels>;

/// The cone as its returns show it from base [paper III-B, LiDAR only]: 0.56 m wide about its axis,
/// from the ground to 0.56 m above it. Each return is spread over the pixels near it, since rings
/// are further apart than pixels. `percent_per_step`: of the intensity byte.
IntensityImage RenderIntensity(const ConeReturns& cone, float percent_per_step);

}  // namespace hairpin
