#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "common/car.hpp"
#include "tools/simulator/lidar/lidar_model.hpp"
#include "tools/simulator/lidar/material.hpp"
#include "tools/simulator/lidar/ray_scene.hpp"

namespace hairpin {

/// The car's own body in base: nose, front wing, wheels, roll hoop, sidepods, rear wing.
class OwnBody {
 public:
  OwnBody(const Car& car, const Surface& paint);
  /// Echo of the body, or an infinite range.
  struct Echo {
    float range;  // [m]
    float echo;   // as in Target
  };
  Echo Cast(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;

 private:
  RayScene rays_;
  Surface paint_;
};

/// What one sensor sees of the car it is mounted on. Both are one rigid body, so it is cast once,
/// for each laser and head azimuth.
class OwnBodyRanges {
 public:
  OwnBodyRanges(const OwnBody& body, const LidarModel& model,
                const Eigen::Isometry3d& T_base_sensor);
  /// `azimuth`: of the beam, clockwise, any angle [rad].
  const OwnBody::Echo& At(size_t channel, double azimuth) const;

 private:
  static constexpr size_t kSteps = 1800;  // of a turn
  std::vector<OwnBody::Echo> echoes_;     // kSteps for each channel
};

/// Unit vector in a sensor's frame (x forward, y left, z up); azimuth clockwise from above.
Eigen::Vector3d BeamDirection(double elevation, double azimuth);

}  // namespace hairpin
