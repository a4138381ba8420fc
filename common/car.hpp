#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "common/config.hpp"

namespace hairpin {

/// Where a LiDAR is mounted, in base: its frame turned by roll, then pitch, then yaw.
struct LidarMount {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double roll = 0.0;
  double pitch = 0.0;  // positive: looks down
  double yaw = 0.0;

  /// T_base_lidar.
  Eigen::Isometry3d Transform() const;
};

/// Geometry and limits of the car, `config/car.yaml`: what more than one daemon needs to know of
/// it. SI; positions in base.
struct Car {
  double mass = 0.0;
  double yaw_inertia = 0.0;  // kg m^2
  double cog_height = 0.0;
  double front_axle = 0.0;  // distance of the axles from the centre of gravity, both positive
  double rear_axle = 0.0;
  double track_width = 0.0;  // between the wheels of an axle
  double wheel_radius = 0.0;
  double front_overhang = 0.0;  // body beyond the centre of gravity, ahead and behind
  double rear_overhang = 0.0;
  double body_width = 0.0;
  double max_steering_angle = 0.0;  // of the front wheels
  double max_wheel_torque = 0.0;    // one motor, at the wheel, driving and regenerating
  double max_brake_force = 0.0;     // both axles together at full brake, at the tyres
  double front_brake_share = 0.0;   // 0 to 1
  double max_motor_power = 0.0;     // of all motors together, W
  double drag = 0.0;                // force per squared speed, N s^2/m^2
  double downforce = 0.0;           // the same
  double rolling_resistance = 0.0;  // N
  Eigen::Vector2d ground_speed_position = Eigen::Vector2d::Zero();
  Eigen::Vector2d gnss_position = Eigen::Vector2d::Zero();
  LidarMount lidar_front;
  LidarMount lidar_top;

  double wheelbase() const { return front_axle + rear_axle; }
  /// Contact points, order fl fr rl rr.
  std::array<Eigen::Vector2d, 4> wheel_positions() const;
};

/// Reads all of `car.yaml` beside `config`'s own file. Problems are collected there.
Car LoadCar(const Config& config);

}  // namespace hairpin
