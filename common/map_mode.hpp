#pragma once

#include <cstdint>

#include "hairpin/pipeline_status_t.hpp"

namespace hairpin {

enum class Pipeline { kFusion = 0, kLidar = 1, kCamera = 2 };
inline constexpr int kNumPipelines = 3;

/// Which pipelines update the local map; numbered as on the wire, rising with what is known.
enum class MapMode {
  kUnknown = pipeline_status_t::MODE_UNKNOWN,
  kNone = pipeline_status_t::MODE_NONE,
  kCameraOnly = pipeline_status_t::MODE_CAMERA_ONLY,
  kLidarOnly = pipeline_status_t::MODE_LIDAR_ONLY,
  kLidarAndCamera = pipeline_status_t::MODE_LIDAR_AND_CAMERA,
  kFusion = pipeline_status_t::MODE_FUSION,
};

/// True if observations of `pipeline` enter the map in `mode`. In FUSION nothing else does: it
/// would be the same information twice [paper III-C].
constexpr bool Uses(MapMode mode, Pipeline pipeline) {
  switch (pipeline) {
    case Pipeline::kFusion:
      return mode == MapMode::kFusion;
    case Pipeline::kLidar:
      return mode == MapMode::kLidarOnly || mode == MapMode::kLidarAndCamera;
    case Pipeline::kCamera:
      return mode == MapMode::kCameraOnly || mode == MapMode::kLidarAndCamera;
  }
  return false;
}

/// "NONE", "CAMERA_ONLY", "LIDAR_ONLY", "LIDAR_AND_CAMERA", "FUSION", "UNKNOWN" for any other
/// number.
constexpr const char* NameOf(MapMode mode) {
  switch (mode) {
    case MapMode::kNone:
      return "NONE";
    case MapMode::kCameraOnly:
      return "CAMERA_ONLY";
    case MapMode::kLidarOnly:
      return "LIDAR_ONLY";
    case MapMode::kLidarAndCamera:
      return "LIDAR_AND_CAMERA";
    case MapMode::kFusion:
      return "FUSION";
    case MapMode::kUnknown:
      break;
  }
  return "UNKNOWN";
}

}  // namespace hairpin
