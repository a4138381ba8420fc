#pragma once

#include <vector>

#include "daemons/lidar_cone_detector/point_cloud.hpp"

namespace hairpin {

/// A sector about base that was looked into: bearings counter-clockwise from x forward [rad].
struct LookedAt {
  float min_bearing;
  float max_bearing;
};

/// The sectors from which any point came, merged where they touch: with a sensor dead or a part of
/// its revolution lost, only what is left. Gaps narrower than a sector's width of 2 degrees are
/// none. At most `max_sectors`, the widest.
std::vector<LookedAt> SectorsLookedAt(const PointCloud& cloud, size_t max_sectors);

}  // namespace hairpin
