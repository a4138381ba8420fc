#include "tools/simulator/motion_sensors.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulator/require.hpp"

namespace hairpin {
namespace {

void Check(const MotionSensorParams& params) {
  RequireNotNegative("gyro_noise", params.gyro_noise_radps);
  RequireNotNegative("gyro_scale", params.gyro_scale);
  RequireNotNegative("accelerometer_noise", params.accelerometer_noise_mps2);
  RequireNotNegative("accelerometer_scale", params.accelerometer_scale);
  RequireNotNegative("wheel_speed_noise", params.wheel_speed_noise_radps);
  RequireNotNegative("wheel_torque_noise", params.wheel_torque_noise_nm);
  RequireNotNegative("wheel_torque_scale", params.wheel_torque_scale);
  RequireNotNegative("steering_noise", params.steering_noise_rad);
  RequireNotNegative("steering_offset", params.steering_offset_rad);
  RequireNotNegative("ground_speed_noise", params.ground_speed_noise_mps);
  RequireNotNegative("ground_speed_scale", params.ground_speed_scale);
  RequireNotNegative("ground_speed_misalignment", params.ground_speed_misalignment_rad);
  RequirePositive("gnss_position_noise", params.gnss_position_noise_m);
  RequirePositive("gnss_velocity_noise", params.gnss_velocity_noise_mps);
  RequirePositive("gnss_heading_noise", params.gnss_heading_noise_rad);
}

// Velocity of a point of the car, in base: v + r x p.
Eigen::Vector2d VelocityAt(const Twist2& velocity, const Eigen::Vector2d& position) {
  return {velocity.vx - velocity.yaw_rate * position.y(),
          velocity.vy + velocity.yaw_rate * position.x()};
}

}  // namespace

MotionSensors::InertialAxis::InertialAxis(double scale_sigma, double bias_sigma, double bias_time,
                                          RandomStream& random)
    : scale(1.0 + random.Gaussian(scale_sigma)), bias(bias_sigma, bias_time, random) {}

double MotionSensors::InertialAxis::Measure(double truth, double noise, double duration,
                                            RandomStream& random) {
  return scale * truth + bias.Step(duration, random) + random.Gaussian(noise);
}

MotionSensors::MotionSensors(const MotionSensorParams& params, const Car& car, uint64_t seed)
    : params_(params),
      car_(car),
      imu_random_(seed, "imu"),
      motors_random_(seed, "motors"),
      steering_random_(seed, "steering"),
      ground_speed_random_(seed, "ground_speed"),
      gnss_random_(seed, "gnss"),
      torque_scale_(1.0 + motors_random_.Gaussian(params.wheel_torque_scale)),
      steering_offset_(steering_random_.Gaussian(params.steering_offset_rad)),
      ground_speed_scale_(1.0 + ground_speed_random_.Gaussian(params.ground_speed_scale)),
      ground_speed_yaw_(ground_speed_random_.Gaussian(params.ground_speed_misalignment_rad)) {
  Check(params);
  for (int axis = 0; axis < 3; ++axis) {
    accelerometers_.emplace_back(params.accelerometer_scale, params.accelerometer_bias_mps2,
                                 params.imu_bias_time_s, imu_random_);
    gyros_.emplace_back(params.gyro_scale, params.gyro_bias_radps, params.imu_bias_time_s,
                        imu_random_);
    gnss_bias_.emplace_back(params.gnss_position_bias_m, params.gnss_position_bias_time_s,
                            gnss_random_);
  }
}

imu_t MotionSensors::Imu(int64_t utime, const VehicleState& state, double duration) {
  imu_t message{};
  message.utime = utime;
  const double acceleration[3] = {state.acceleration.x(), state.acceleration.y(), 0.0};
  const double rate[3] = {0.0, 0.0, state.velocity.yaw_rate};
  for (size_t i = 0; i < 3; ++i) {
    message.acceleration_mps2[i] = accelerometers_[i].Measure(
        acceleration[i], params_.accelerometer_noise_mps2, duration, imu_random_);
    message.angular_rate_radps[i] =
        gyros_[i].Measure(rate[i], params_.gyro_noise_radps, duration, imu_random_);
  }
  return message;
}

motors_t MotionSensors::Motors(int64_t utime, const VehicleState& state) {
  motors_t message{};
  message.utime = utime;
  for (size_t i = 0; i < 4; ++i) {
    message.wheel_speed_radps[i] =
        state.wheel_speed[i] + motors_random_.Gaussian(params_.wheel_speed_noise_radps);
    message.wheel_torque_nm[i] = torque_scale_ * state.wheel_torque[i] +
                                 motors_random_.Gaussian(params_.wheel_torque_noise_nm);
  }
  return message;
}

steering_t MotionSensors::Steering(int64_t utime, const VehicleState& state) {
  steering_t message{};
  message.utime = utime;
  message.wheel_angle_rad = state.steering_angle + steering_offset_ +
                            steering_random_.Gaussian(params_.steering_noise_rad);
  return message;
}

ground_speed_t MotionSensors::GroundSpeed(int64_t utime, const VehicleState& state) {
  ground_speed_t message{};
  message.utime = utime;
  const Eigen::Vector2d velocity_base = VelocityAt(state.velocity, car_.ground_speed_position);
  const Eigen::Vector2d velocity_sensor = Pose2{0.0, 0.0, -ground_speed_yaw_} * velocity_base;
  for (int i = 0; i < 2; ++i) {
    message.velocity_mps[i] = ground_speed_scale_ * velocity_sensor[i] +
                              ground_speed_random_.Gaussian(params_.ground_speed_noise_mps);
  }
  message.quality = 1.0;
  return message;
}

gnss_t MotionSensors::Gnss(int64_t utime, const VehicleState& state, double duration) {
  gnss_t message{};
  message.utime = utime;
  message.fix = params_.gnss_fix;
  const Eigen::Vector2d position_map = state.T_map_base * car_.gnss_position;
  const Eigen::Vector2d velocity_map =
      state.T_map_base.rotation() * VelocityAt(state.velocity, car_.gnss_position);
  const double position[3] = {position_map.x(), position_map.y(), 0.0};
  const double velocity[3] = {velocity_map.x(), velocity_map.y(), 0.0};
  for (size_t i = 0; i < 3; ++i) {
    message.position_enu_m[i] = position[i] + gnss_bias_[i].Step(duration, gnss_random_) +
                                gnss_random_.Gaussian(params_.gnss_position_noise_m);
    message.position_sigma_m[i] =
        std::hypot(params_.gnss_position_bias_m, params_.gnss_position_noise_m);
    message.velocity_enu_mps[i] =
        velocity[i] + gnss_random_.Gaussian(params_.gnss_velocity_noise_mps);
    message.velocity_sigma_mps[i] = params_.gnss_velocity_noise_mps;
  }
  message.heading_valid = true;
  message.heading_rad =
      WrapAngle(state.T_map_base.yaw + gnss_random_.Gaussian(params_.gnss_heading_noise_rad));
  message.heading_sigma_rad = params_.gnss_heading_noise_rad;
  return message;
}

}  // namespace hairpin
