#include "daemons/velocity_estimator/standstill.hpp"

#include <algorithm>
#include <cmath>

#include "common/clock.hpp"

namespace hairpin {

bool Standstill::WheelsLookStill(const MotorsReading& motors) const {
  for (size_t i = 0; i < motors.speed.size(); ++i) {
    if (std::abs(motors.speed[i]) > params_.max_wheel_speed) return false;
    if (motors.torque && std::abs((*motors.torque)[i]) > params_.max_wheel_torque) return false;
  }
  return true;
}

bool Standstill::Detect(const ImuReading& imu, const std::optional<MotorsReading>& motors,
                        const std::optional<GroundSpeedReading>& ground_speed) {
  const bool is_quiet = std::abs(imu.yaw_rate) <= params_.max_yaw_rate &&
                        imu.acceleration.norm() <= params_.max_acceleration;
  const bool is_slow =
      motors ? WheelsLookStill(*motors)
             : ground_speed && ground_speed->velocity.norm() <= params_.max_ground_speed;
  if (!is_quiet || !is_slow) {
    still_since_.reset();
    return false;
  }
  if (!still_since_) still_since_ = imu.utime;
  return SecondsBetween(*still_since_, imu.utime) >= params_.hold;
}

void Standstill::LearnBias(const ImuReading& imu, double dt) {
  averaged_ = std::min(averaged_ + dt, params_.bias_window);
  const double weight = std::min(dt / averaged_, 1.0);
  gyro_bias_ += weight * (imu.yaw_rate - gyro_bias_);
  gyro_bias_ = std::clamp(gyro_bias_, -params_.max_gyro_bias, params_.max_gyro_bias);
  accelerometer_bias_ += weight * (imu.acceleration - accelerometer_bias_);
  const double size = accelerometer_bias_.norm();
  if (size > params_.max_accelerometer_bias)
    accelerometer_bias_ *= params_.max_accelerometer_bias / size;
}

}  // namespace hairpin
