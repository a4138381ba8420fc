#pragma once

#include <string_view>
#include <vector>

#include "common/cone.hpp"
#include "daemons/lidar_cone_detector/cone_returns.hpp"
#include "daemons/lidar_cone_detector/lidar_cone_detector.hpp"
#include "daemons/lidar_cone_detector/scan_pairing.hpp"
#include "daemons/lidar_cone_detector/view.hpp"
#include "hairpin/cone_clusters_t.hpp"
#include "hairpin/cones_t.hpp"

namespace hairpin {

/// Checked conversion from the wire. Returns what is wrong, empty if nothing.
std::string_view ToRevolution(const lidar_scan_t& message, LidarRevolution& revolution);

/// The cones' returns, from the cloud that they were detected in.
std::vector<ConeReturns> ReturnsOf(const PointCloud& cloud, const std::vector<float>& heights,
                                   const std::vector<DetectedCone>& cones);

/// Both messages of one detection. `returns` and `colours` go with the cones, one each.
cone_clusters_t ToClustersMessage(int64_t utime, const std::vector<DetectedCone>& cones,
                                  const std::vector<ConeReturns>& returns,
                                  const std::vector<ColourDistribution>& colours,
                                  const std::vector<LookedAt>& sectors, double max_range);
cones_t ToConesMessage(const cone_clusters_t& clusters);

}  // namespace hairpin
