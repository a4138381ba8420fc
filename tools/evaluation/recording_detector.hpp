#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemons/lidar_cone_detector/lidar_cone_detector_node.hpp"
#include "tools/evaluation/recorded_scans.hpp"
#include "tools/evaluation/recorded_sensor.hpp"

namespace hairpin {

/// One recorded scan with what the detector found in it; colours and returns go with the cones.
struct DetectedScan {
  RecordedScan scan;
  std::vector<DetectedCone> cones;  // base
  std::vector<ConeReturns> returns;
  std::vector<ColourDistribution> colours;
};

/// lidar_cone_detector's algorithm on a recording, scan by scan.
class RecordingDetector {
 public:
  /// `rings`: 64, or fewer by leaving some out. Throws RecordingError.
  RecordingDetector(const std::string& run, int rings, const LidarConeDetectorNodeParams& params);

  /// Empty at the end. Throws RecordingError.
  std::optional<DetectedScan> Next();

  /// Of the scan that Next() returned last.
  const PointCloud& cloud() const { return cloud_; }
  LidarConeDetector& detector() { return detector_; }
  /// The sensor's place in base [m].
  Eigen::Vector2d sensor_position() const;

 private:
  int keep_every_;
  RecordedSensor sensor_;
  std::vector<SensorGeometry> sensors_;
  LidarConeDetector detector_;
  ColourClassifier classifier_;
  RecordedScanReader reader_;
  PointCloud cloud_;
};

}  // namespace hairpin
