#include "daemons/lidar_cone_detector/view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "daemons/lidar_cone_detector/polar_grid.hpp"

namespace hairpin {
namespace {

constexpr int kSlices = 180;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kSlice = 2.0f * kPi / kSlices;
constexpr int kFewPoints = 3;  // a lone return in a slice is no view into it

using Slices = std::array<bool, kSlices>;

Slices SeenSlices(const PointCloud& cloud) {
  std::array<int, kSlices> count{};
  std::array<int, 1024> slice;  // in blocks, so that several bearings are computed at once
  for (size_t begin = 0; begin < cloud.size(); begin += slice.size()) {
    const size_t size = std::min(slice.size(), cloud.size() - begin);
    const float* x = cloud.x.data() + begin;
    const float* y = cloud.y.data() + begin;
    for (size_t i = 0; i < size; ++i)
      slice[i] = static_cast<int>((FastBearing(y[i], x[i]) + kPi) * (1.0f / kSlice));
    for (size_t i = 0; i < size; ++i) ++count[static_cast<size_t>(std::min(slice[i], kSlices - 1))];
  }
  Slices seen{};
  for (size_t k = 0; k < seen.size(); ++k) seen[k] = count[k] >= kFewPoints;
  return seen;
}

}  // namespace

std::vector<LookedAt> SectorsLookedAt(const PointCloud& cloud, size_t max_sectors) {
  const Slices seen = SeenSlices(cloud);
  const auto gap = std::find(seen.begin(), seen.end(), false);
  if (gap == seen.end()) return {{-kPi, kPi}};
  // From a gap once around, so that no run is cut in two.
  const auto start = static_cast<int>(gap - seen.begin());
  std::vector<LookedAt> sectors;
  for (int k = start, begin = -1; k <= start + kSlices; ++k) {
    const bool open = k < start + kSlices && seen[static_cast<size_t>(k % kSlices)];
    if (open && begin < 0) begin = k;
    if (open || begin < 0) continue;
    const float turn = begin >= kSlices ? 2.0f * kPi : 0.0f;
    sectors.push_back({static_cast<float>(begin) * kSlice - kPi - turn,
                       static_cast<float>(k) * kSlice - kPi - turn});
    begin = -1;
  }
  std::stable_sort(sectors.begin(), sectors.end(), [](const LookedAt& a, const LookedAt& b) {
    return a.max_bearing - a.min_bearing > b.max_bearing - b.min_bearing;
  });
  if (sectors.size() > max_sectors) sectors.resize(max_sectors);
  return sectors;
}

}  // namespace hairpin
