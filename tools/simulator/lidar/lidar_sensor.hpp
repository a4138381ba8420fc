#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "tools/simulator/lidar/beam.hpp"
#include "tools/simulator/lidar/lidar_model.hpp"
#include "tools/simulator/lidar/own_body.hpp"
#include "tools/simulator/lidar/scene.hpp"

namespace hairpin {

struct LidarSensorParams {
  LidarModel model;
  BeamParams beam;
  double rotation_hz = 0.0;
  double start_azimuth_rad = 0.0;  // of the head at time 0, clockwise
};

/// One firing sequence: every laser once.
struct FiringSequence {
  int64_t start_ns = 0;              // of its first laser, since time 0
  double azimuth_rad = 0.0;          // of the head then, clockwise, in [0, 2 pi)
  std::vector<LidarReturn> returns;  // by channel
};

/// Where a body moves from and to in an interval, T_map_base.
struct BodyMotion {
  int64_t from_ns = 0;
  int64_t to_ns = 0;
  Eigen::Isometry3d T_map_from = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_map_to = Eigen::Isometry3d::Identity();

  /// In between, constant velocity and turn rate. Within 0 and 1 of the interval, or outside.
  Eigen::Isometry3d At(int64_t time_ns) const;
};

/// A rotating LiDAR on the car: casts each firing sequence at its own time and pose.
class LidarSensor {
 public:
  /// `T_base_sensor`: mount. `seed`: of the noise. Throws std::invalid_argument for values that
  /// cannot be.
  LidarSensor(const LidarSensorParams& params, const Eigen::Isometry3d& T_base_sensor,
              const OwnBody& body, uint64_t seed);

  /// The firing sequences that begin in [from, to) of `motion`, in their order.
  std::vector<FiringSequence> Scan(const LidarScene& scene, const BodyMotion& motion) const;

  const LidarSensorParams& params() const { return params_; }
  /// Unit vector of a laser's beam in the sensor's frame (x forward, y left, z up) at time
  /// `time_ns`.
  Eigen::Vector3d Direction(size_t channel, int64_t time_ns) const;

 private:
  double HeadAzimuth(int64_t time_ns) const;
  FiringSequence Fire(const LidarScene& scene, const BodyMotion& motion, int64_t index) const;
  LidarReturn FireLaser(const LidarScene& scene, const Eigen::Isometry3f& T_map_sensor,
                        size_t channel, int64_t time_ns, HashRandom& random) const;

  LidarSensorParams params_;
  Eigen::Isometry3d T_base_sensor_;
  uint64_t seed_;
  std::vector<double> laser_bias_;
  OwnBodyRanges own_body_;
};

}  // namespace hairpin
