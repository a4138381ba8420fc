#pragma once

#include "common/config.hpp"
#include "daemons/lidar_cone_detector/lidar_cone_detector.hpp"

namespace hairpin {

/// The part of lidar_cone_detector.yaml that the algorithm needs; the caller reads the rest and
/// finishes. Problems are collected in `config`.
LidarConeDetectorParams LoadDetectorParams(const Config& config);

}  // namespace hairpin
