#pragma once

#include "daemons/lidar_cone_detector/point_cloud.hpp"
#include "tools/evaluation/recorded_scans.hpp"

namespace hairpin {

/// The sensor of the recorded car, as far as the recordings tell: 64 rings below the horizon, 1024
/// firings at 20 revolutions a second, clockwise, ending behind the car. Where it sits was fitted
/// to the rings that flat ground shows; recordings hold no rings, so a point's ring is what its
/// elevation says once the deskewing has been undone.
class RecordedSensor {
 public:
  static constexpr int kRings = 64;

  RecordedSensor();

  /// As the detector takes it. `keep_every`: 1 for all rings, 2 to thin 64 to 32 by elevation.
  /// Points on the recorded car's own body are left out.
  void ToCloud(const RecordedScan& scan, int keep_every, PointCloud& cloud) const;
  /// What the detector shall know of it, thinned in the same way.
  SensorGeometry Geometry(int keep_every) const;

 private:
  Eigen::Isometry3f T_base_sensor_;
  Eigen::Isometry3f T_sensor_base_;
};

}  // namespace hairpin
