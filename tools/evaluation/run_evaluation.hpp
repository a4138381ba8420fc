#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemons/global_mapper/global_mapper_node.hpp"
#include "daemons/lidar_cone_detector/lidar_cone_detector_node.hpp"
#include "daemons/local_mapper/local_mapper_node.hpp"
#include "tools/evaluation/recorded_scans.hpp"
#include "tools/report/map_comparison.hpp"

namespace hairpin {

struct MappedRunParams {
  LidarConeDetectorNodeParams detector;
  LocalMapperParams local_mapper;
  GlobalMapperConfig global_mapper;
  int rings = 64;  // of the recorded 64
};

/// What the mapping chain made of a recorded drive.
struct MappedRun {
  MapComparison comparison;             // of the last global map, aligned to the survey
  std::vector<Eigen::Vector2d> driven;  // as it was estimated meanwhile, in the survey's frame [m]
  int scans = 0;
  int local_epochs = 0;  // beginnings of the local map, one more than gaps in the recording
  double max_speed = 0.0;
  bool loop_closed = false;
};

/// Feeds recorded scans and their velocities through the detector and the nodes of local_mapper and
/// global_mapper, as on the car, and compares the map that comes out with the survey. Throws
/// RecordingError.
MappedRun MapRecording(const std::string& run, const std::vector<SurveyedCone>& survey,
                       const MappedRunParams& params);

nlohmann::json ToJson(const MappedRun& run);

/// An SVG picture: surveyed cones (filled), mapped ones (rings; red where they are false), the way
/// driven.
std::string DrawMappedRun(const MappedRun& run, const std::vector<SurveyedCone>& survey);

}  // namespace hairpin
