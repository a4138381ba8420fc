#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "daemons/velocity_estimator/measurements.hpp"

namespace hairpin {

struct StandstillParams {
  double hold = 0.0;                    // s that all signs must have lasted
  double max_wheel_speed = 0.0;         // rad/s, every wheel
  double max_ground_speed = 0.0;        // m/s, optical; asked where the wheels are not heard
  double max_wheel_torque = 0.0;        // N m, every wheel
  double max_yaw_rate = 0.0;            // rad/s
  double max_acceleration = 0.0;        // m/s^2
  double velocity_sigma = 0.0;          // m/s, of the zero-velocity update
  double yaw_rate_sigma = 0.0;          // rad/s
  double bias_window = 0.0;             // s over which biases are averaged
  double max_gyro_bias = 0.0;           // rad/s
  double max_accelerometer_bias = 0.0;  // m/s^2
};

/// Notices that the car stands still, and measures the biases of gyro and accelerometer while it
/// does: whatever they show then is bias (and, of the accelerometer, what the removal of gravity
/// has left).
class Standstill {
 public:
  explicit Standstill(const StandstillParams& params) : params_(params) {}

  /// Takes one IMU reading as it comes and the wheels, if heard with it; without them the optical
  /// sensor. Returns whether the car seems to stand still.
  bool Detect(const ImuReading& imu, const std::optional<MotorsReading>& motors,
              const std::optional<GroundSpeedReading>& ground_speed = std::nullopt);

  /// Averages a reading of a car that stands, `dt` [s] after the one before.
  void LearnBias(const ImuReading& imu, double dt);

  double gyro_bias() const { return gyro_bias_; }
  const Eigen::Vector2d& accelerometer_bias() const { return accelerometer_bias_; }

 private:
  bool WheelsLookStill(const MotorsReading& motors) const;

  StandstillParams params_;
  std::optional<int64_t> still_since_;
  double averaged_ = 0.0;  // s behind the means, up to the window
  double gyro_bias_ = 0.0;
  Eigen::Vector2d accelerometer_bias_ = Eigen::Vector2d::Zero();
};

}  // namespace hairpin
