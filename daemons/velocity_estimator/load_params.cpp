#include "daemons/velocity_estimator/velocity_estimator_node.hpp"

namespace hairpin {
namespace {

SlipParams LoadSlip(const Config& config) {
  return {.sigma_free = config.Number("sigma_free", {0.001, 0.1}),
          .sigma_at_limit = config.Number("sigma_at_limit", {0.001, 1.0}),
          .time_constant = config.Number("time_constant_s", {0.01, 5.0}),
          .friction = config.Number("friction", {0.1, 3.0}),
          .min_speed = config.Number("min_speed_mps", {0.1, 10.0})};
}

LateralTyreParams LoadTyre(const Config& config) {
  return {.stiffness = config.Number("stiffness_per_load", {1.0, 100.0}),
          .shape = config.Number("shape", {1.0, 2.0}),
          .sigma_angle = config.Number("sigma_angle_rad", {1e-4, 0.2}),
          .sigma_angle_share = config.Number("sigma_angle_share", {0.01, 2.0}),
          .angle_time_constant = config.Number("angle_time_constant_s", {0.01, 5.0})};
}

SensorNoise LoadNoise(const Config& config) {
  return {.gyro = config.Number("gyro_radps", {1e-4, 0.5}),
          .accelerometer = config.Number("accelerometer_mps2", {1e-3, 10.0}),
          .ground_speed = config.Number("ground_speed_mps", {1e-3, 2.0}),
          .ground_speed_scale = config.Number("ground_speed_scale", {1e-4, 0.1}),
          .wheel_speed = config.Number("wheel_speed_radps", {1e-3, 5.0}),
          .steering = config.Number("steering_rad", {1e-4, 0.1}),
          .steering_yaw_rate = config.Number("steering_yaw_rate_radps", {1e-3, 1.0}),
          .steering_yaw_rate_scale = config.Number("steering_yaw_rate_scale", {1e-3, 2.0}),
          .gnss_velocity = config.Number("gnss_velocity_mps", {1e-3, 2.0}),
          .gnss_heading = config.Number("gnss_heading_rad", {1e-4, 0.5})};
}

StandstillParams LoadStandstill(const Config& config) {
  return {.hold = config.Number("hold_s", {0.05, 5.0}),
          .max_wheel_speed = config.Number("max_wheel_speed_radps", {0.01, 5.0}),
          .max_ground_speed = config.Number("max_ground_speed_mps", {0.01, 1.0}),
          .max_wheel_torque = config.Number("max_wheel_torque_nm", {0.1, 100.0}),
          .max_yaw_rate = config.Number("max_yaw_rate_radps", {0.001, 0.5}),
          .max_acceleration = config.Number("max_acceleration_mps2", {0.01, 5.0}),
          .velocity_sigma = config.Number("velocity_sigma_mps", {1e-4, 0.5}),
          .yaw_rate_sigma = config.Number("yaw_rate_sigma_radps", {1e-5, 0.1}),
          .bias_window = config.Number("bias_window_s", {0.1, 600.0}),
          .max_gyro_bias = config.Number("max_gyro_bias_radps", {1e-5, 0.1}),
          .max_accelerometer_bias = config.Number("max_accelerometer_bias_mps2", {1e-4, 2.0})};
}

VoteParams LoadVote(const Config& config) {
  return {.time_constant = config.Number("time_constant_s", {0.05, 10.0}),
          .speed_offset = config.Number("speed_offset_mps", {0.01, 5.0}),
          .speed_scale = config.Number("speed_scale", {1e-3, 0.5}),
          .gyro_offset = config.Number("gyro_offset_radps", {1e-3, 0.5}),
          .heading_rate = config.Number("heading_rate_radps", {1e-3, 1.0}),
          .lateral_acceleration = config.Number("lateral_acceleration_mps2", {0.1, 20.0}),
          .min_speed = config.Number("min_speed_mps", {0.5, 20.0})};
}

SensorMonitorParams LoadMonitor(const Config& config) {
  return {.reject_after = config.Number("reject_after_s", {0.05, 10.0}),
          .readmit_after = config.Number("readmit_after_s", {0.05, 60.0}),
          .frozen_after = config.Number("frozen_after_s", {0.05, 10.0})};
}

VelocityEstimatorParams LoadEstimator(const Config& config) {
  const Config motion = config.Section("motion_noise");
  const Config gate = config.Section("gate");
  const Config time = config.Section("time");
  const Config valid = config.Section("valid");
  VelocityEstimatorParams params;
  params.car = LoadCar(config);
  params.motion = {.velocity = motion.Number("velocity_mps_per_sqrt_s", {1e-4, 10.0}),
                   .yaw_rate = motion.Number("yaw_rate_radps_per_sqrt_s", {1e-3, 50.0}),
                   .acceleration = motion.Number("acceleration_mps2_per_sqrt_s", {1e-2, 500.0})};
  params.slip = LoadSlip(config.Section("slip"));
  params.tyre = LoadTyre(config.Section("tyre"));
  params.noise = LoadNoise(config.Section("sensor_noise"));
  params.deadlines = {.imu = channels::kImu.deadline_s,
                      .ground_speed = channels::kGroundSpeed.deadline_s,
                      .motors = channels::kMotors.deadline_s,
                      .steering = channels::kSteering.deadline_s,
                      .gnss = channels::kGnss.deadline_s};
  params.monitor = LoadMonitor(config.Section("monitor"));
  params.standstill = LoadStandstill(config.Section("standstill"));
  params.vote = LoadVote(config.Section("vote"));
  params.gate_1dof = gate.Number("chi_square_1dof", {1.0, 100.0});
  params.gate_2dof = gate.Number("chi_square_2dof", {1.0, 100.0});
  params.max_age = time.Number("max_age_s", {0.001, 0.5});
  params.max_gap = time.Number("max_gap_s", {0.05, 2.0});
  params.max_velocity_sigma = valid.Number("max_velocity_sigma_mps", {0.01, 5.0});
  params.max_yaw_rate_sigma = valid.Number("max_yaw_rate_sigma_radps", {0.001, 1.0});
  return params;
}

}  // namespace

VelocityEstimatorNodeParams LoadVelocityEstimatorParams(const Config& config) {
  VelocityEstimatorNodeParams params;
  params.estimator = LoadEstimator(config);
  const Config limits = config.Section("limits");
  params.limits = {.max_speed = limits.Number("max_speed_mps", {5.0, 200.0}),
                   .max_yaw_rate = limits.Number("max_angular_rate_radps", {1.0, 50.0}),
                   .max_acceleration = limits.Number("max_acceleration_mps2", {10.0, 500.0}),
                   .min_quality = limits.Number("min_ground_speed_quality", {0.0, 1.0})};
  config.Finish();
  return params;
}

}  // namespace hairpin
