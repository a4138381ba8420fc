#include "daemons/velocity_estimator/velocity_estimator_params.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace hairpin {
namespace {

void Require(bool holds, const char* name, double value, const char* relation, double bound) {
  if (holds) return;
  std::ostringstream text;
  text << "velocity_estimator: " << name << " = " << value << " must be " << relation << ' '
       << bound;
  throw std::invalid_argument(text.str());
}

void RequirePositive(const char* name, double value) {
  Require(std::isfinite(value) && value > 0.0, name, value, ">", 0.0);
}

void ValidateCar(const Car& car) {
  RequirePositive("car.mass", car.mass);
  RequirePositive("car.wheel_radius", car.wheel_radius);
  RequirePositive("car.track_width", car.track_width);
  Require(car.front_brake_share >= 0.0 && car.front_brake_share <= 1.0, "car.front_brake_share",
          car.front_brake_share, "from 0 to", 1.0);
}

void ValidateNoise(const VelocityEstimatorParams& params) {
  RequirePositive("motion.velocity", params.motion.velocity);
  RequirePositive("motion.yaw_rate", params.motion.yaw_rate);
  RequirePositive("motion.acceleration", params.motion.acceleration);
  RequirePositive("slip.sigma_free", params.slip.sigma_free);
  RequirePositive("slip.sigma_at_limit", params.slip.sigma_at_limit);
  RequirePositive("slip.time_constant", params.slip.time_constant);
  RequirePositive("slip.friction", params.slip.friction);
  RequirePositive("slip.min_speed", params.slip.min_speed);
  RequirePositive("tyre.stiffness", params.tyre.stiffness);
  Require(params.tyre.shape >= 1.0, "tyre.shape", params.tyre.shape, ">=", 1.0);
  RequirePositive("tyre.sigma_angle", params.tyre.sigma_angle);
  RequirePositive("tyre.sigma_angle_share", params.tyre.sigma_angle_share);
  RequirePositive("tyre.angle_time_constant", params.tyre.angle_time_constant);
  RequirePositive("noise.gyro", params.noise.gyro);
  RequirePositive("noise.accelerometer", params.noise.accelerometer);
  RequirePositive("noise.ground_speed", params.noise.ground_speed);
  RequirePositive("noise.ground_speed_scale", params.noise.ground_speed_scale);
  RequirePositive("noise.wheel_speed", params.noise.wheel_speed);
  RequirePositive("noise.steering", params.noise.steering);
  RequirePositive("noise.steering_yaw_rate", params.noise.steering_yaw_rate);
  RequirePositive("noise.steering_yaw_rate_scale", params.noise.steering_yaw_rate_scale);
  RequirePositive("noise.gnss_velocity", params.noise.gnss_velocity);
  RequirePositive("noise.gnss_heading", params.noise.gnss_heading);
}

void ValidateTimes(const VelocityEstimatorParams& params) {
  RequirePositive("deadlines.imu", params.deadlines.imu);
  RequirePositive("deadlines.ground_speed", params.deadlines.ground_speed);
  RequirePositive("deadlines.motors", params.deadlines.motors);
  RequirePositive("deadlines.steering", params.deadlines.steering);
  RequirePositive("deadlines.gnss", params.deadlines.gnss);
  RequirePositive("monitor.reject_after", params.monitor.reject_after);
  RequirePositive("monitor.readmit_after", params.monitor.readmit_after);
  RequirePositive("monitor.frozen_after", params.monitor.frozen_after);
  RequirePositive("max_age", params.max_age);
  Require(params.max_gap >= params.max_age, "max_gap", params.max_gap,
          ">= max_age =", params.max_age);
  // The prediction over a gap goes in small steps; their number is the work of one message.
  Require(params.max_gap <= 2.0, "max_gap", params.max_gap, "<=", 2.0);
}

void ValidateStandstill(const StandstillParams& params) {
  RequirePositive("standstill.hold", params.hold);
  RequirePositive("standstill.max_wheel_speed", params.max_wheel_speed);
  RequirePositive("standstill.max_ground_speed", params.max_ground_speed);
  RequirePositive("standstill.max_wheel_torque", params.max_wheel_torque);
  RequirePositive("standstill.max_yaw_rate", params.max_yaw_rate);
  RequirePositive("standstill.max_acceleration", params.max_acceleration);
  RequirePositive("standstill.velocity_sigma", params.velocity_sigma);
  RequirePositive("standstill.yaw_rate_sigma", params.yaw_rate_sigma);
  RequirePositive("standstill.bias_window", params.bias_window);
  RequirePositive("standstill.max_gyro_bias", params.max_gyro_bias);
  RequirePositive("standstill.max_accelerometer_bias", params.max_accelerometer_bias);
}

void ValidateVote(const VoteParams& params) {
  RequirePositive("vote.time_constant", params.time_constant);
  RequirePositive("vote.speed_offset", params.speed_offset);
  RequirePositive("vote.speed_scale", params.speed_scale);
  RequirePositive("vote.gyro_offset", params.gyro_offset);
  RequirePositive("vote.heading_rate", params.heading_rate);
  RequirePositive("vote.lateral_acceleration", params.lateral_acceleration);
  RequirePositive("vote.min_speed", params.min_speed);
}

}  // namespace

void Validate(const VelocityEstimatorParams& params) {
  ValidateCar(params.car);
  ValidateNoise(params);
  ValidateTimes(params);
  ValidateStandstill(params.standstill);
  ValidateVote(params.vote);
  RequirePositive("gate_1dof", params.gate_1dof);
  Require(params.gate_2dof > params.gate_1dof, "gate_2dof", params.gate_2dof,
          "> gate_1dof =", params.gate_1dof);
  RequirePositive("max_velocity_sigma", params.max_velocity_sigma);
  RequirePositive("max_yaw_rate_sigma", params.max_yaw_rate_sigma);
}

}  // namespace hairpin
