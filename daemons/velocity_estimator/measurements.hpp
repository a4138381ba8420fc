#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

namespace hairpin {

/// Per wheel, order fl fr rl rr.
using Wheels = std::array<double, 4>;

/// Specific force without gravity [m/s^2] and yaw rate [rad/s], in base.
struct ImuReading {
  int64_t utime = 0;
  Eigen::Vector2d acceleration = Eigen::Vector2d::Zero();
  double yaw_rate = 0.0;
};

/// Velocity of the sensor's own position over the ground, in base [m/s].
struct GroundSpeedReading {
  int64_t utime = 0;
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
};

/// Wheel speeds [rad/s] and motor torques at the wheels [N m]; none where the currents are not
/// measured.
struct MotorsReading {
  int64_t utime = 0;
  Wheels speed{};
  std::optional<Wheels> torque;
};

/// Angle of the front wheels, positive to the left [rad].
struct SteeringReading {
  int64_t utime = 0;
  double angle = 0.0;
};

/// Velocity of the antenna, east and north [m/s], with the heading of base's x axis from east
/// [rad].
struct GnssReading {
  int64_t utime = 0;
  Eigen::Vector2d velocity_enu = Eigen::Vector2d::Zero();
  Eigen::Vector2d velocity_sigma = Eigen::Vector2d::Zero();
  double heading = 0.0;
  double heading_sigma = 0.0;
};

/// What one step of the filter has to go by: the newest of each sensor since the step before,
/// steering as long as it is fresh.
struct Readings {
  std::optional<ImuReading> imu;
  std::optional<GroundSpeedReading> ground_speed;
  std::optional<MotorsReading> motors;
  std::optional<SteeringReading> steering;
  std::optional<GnssReading> gnss;
};

}  // namespace hairpin
