#pragma once

#include "daemons/lidar_cone_detector/lidar_cone_detector_node.hpp"

namespace hairpin {

/// The parameters of config/lidar_cone_detector.yaml and car.yaml.
inline LidarConeDetectorNodeParams ShippedParams() {
  return LoadLidarConeDetectorParams(
      Config::Load(HAIRPIN_SOURCE_DIR "/config", "lidar_cone_detector"));
}

}  // namespace hairpin
