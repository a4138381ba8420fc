#include "tools/evaluation/recording_detector.hpp"

#include "daemons/lidar_cone_detector/conversion.hpp"

namespace hairpin {

RecordingDetector::RecordingDetector(const std::string& run, int rings,
                                     const LidarConeDetectorNodeParams& params)
    : keep_every_(RecordedSensor::kRings / rings),
      sensors_{sensor_.Geometry(keep_every_)},
      detector_(params.detector),
      classifier_(params.colour),
      reader_(run) {}

std::optional<DetectedScan> RecordingDetector::Next() {
  std::optional<RecordedScan> scan = reader_.Next();
  if (!scan) return std::nullopt;
  sensor_.ToCloud(*scan, keep_every_, cloud_);
  DetectedScan detected{std::move(*scan), detector_.Detect(cloud_, sensors_), {}, {}};
  detected.returns = ReturnsOf(cloud_, detector_.heights(), detected.cones);
  detected.colours = classifier_.Classify(detected.returns);
  return detected;
}

Eigen::Vector2d RecordingDetector::sensor_position() const {
  return sensors_[0].T_base_sensor.translation().head<2>().cast<double>();
}

}  // namespace hairpin
