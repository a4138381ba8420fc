#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/bus.hpp"
#include "common/config.hpp"
#include "common/lidar_scan.hpp"
#include "common/pose_history.hpp"
#include "daemons/lidar_cone_detector/body_box.hpp"
#include "daemons/lidar_cone_detector/colour_classifier.hpp"
#include "daemons/lidar_cone_detector/lidar_cone_detector.hpp"
#include "daemons/lidar_cone_detector/scan_pairing.hpp"

namespace hairpin {

struct LidarConeDetectorNodeParams {
  LidarConeDetectorParams detector;
  ColourParams colour;
  std::array<Eigen::Isometry3f, kNumLidars> T_base_sensor;
  BodyBox body;
  ScanPairingParams pairing;
  double max_speed = 0.0;     // beyond it a velocity is absurd [m/s]
  double max_yaw_rate = 0.0;  // [rad/s]
};

/// LIDAR_FRONT, LIDAR_TOP and VELOCITY in; one CONE_CLUSTERS and one CONES_LIDAR out for each pair
/// of scans of about the same time, or for a scan whose partner does not come, with the newest
/// scan's utime.
class LidarConeDetectorNode {
 public:
  LidarConeDetectorNode(const LidarConeDetectorNodeParams& params, Bus& bus);

  /// For evaluation: what the last message was detected in, and how.
  const PointCloud& cloud() const { return cloud_; }
  const LidarConeDetector& detector() const { return detector_; }
  void OnStageDone(std::function<void(DetectorStage)> listener) {
    detector_.OnStageDone(std::move(listener));
  }

 private:
  void SubscribeScans(const Channel<lidar_scan_t>& channel, size_t lidar);
  void OnVelocity(const velocity_t& velocity);
  void RunWhatIsReady();
  void Detect(const ScanSet& scans);
  void Publish(int64_t utime, const std::vector<DetectedCone>& cones);

  LidarConeDetectorNodeParams params_;
  Bus& bus_;
  LidarConeDetector detector_;
  ColourClassifier colours_;
  PoseHistory history_;
  ScanPairing pairing_;
  PointCloud cloud_;
  std::vector<SensorGeometry> geometry_;
};

/// Reads all of lidar_cone_detector.yaml, and the mounts and the body from car.yaml. Throws
/// ConfigError.
LidarConeDetectorNodeParams LoadLidarConeDetectorParams(const Config& config);

}  // namespace hairpin
