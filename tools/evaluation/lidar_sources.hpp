#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "daemons/lidar_cone_detector/lidar_cone_detector_node.hpp"
#include "tools/evaluation/lidar_evaluation.hpp"

namespace hairpin {

/// One detection with its truth.
struct EvaluatedScan {
  int64_t number;
  const PointCloud& cloud;
  const LidarConeDetector& detector;
  const std::vector<ScannedCone>& truth;  // returns counted
  const std::vector<LidarDetection>& detections;
  Eigen::Vector2d sensor;         // of the foremost, in base
  const std::vector<double>& ms;  // wall time of each stage, then of all
};
using ScanListener = std::function<void(const EvaluatedScan&)>;

/// The detector on recorded scans against a surveyed map. Throws RecordingError.
void DetectInRecording(const std::string& run, const std::string& map, int rings,
                       const LidarConeDetectorNodeParams& params, const ScanListener& listener);

/// The daemon's node on the LIDAR_* and VELOCITY of a log that also holds TRUTH and TRUTH_TRACK;
/// scans without truth about them are left out. Throws RecordingError.
void DetectInLog(const std::string& log, const LidarConeDetectorNodeParams& params,
                 const ScanListener& listener);

}  // namespace hairpin
