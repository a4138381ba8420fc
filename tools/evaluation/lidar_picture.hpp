#pragma once

#include <string>
#include <vector>

#include "tools/evaluation/lidar_evaluation.hpp"

namespace hairpin {

/// An SVG picture of one scan in base, x to the right: points (ground grey, what stands on it by
/// height), true cones (dots, with the number of their returns), detections (green rings; red where
/// no cone is near), true cones that were missed (red crosses), and refused candidates (small
/// violet rings).
std::string DrawScan(int64_t number, const PointCloud& cloud, const std::vector<float>& heights,
                     const std::vector<Candidate>& candidates,
                     const std::vector<ScannedCone>& cones,
                     const std::vector<LidarDetection>& detections);

}  // namespace hairpin
