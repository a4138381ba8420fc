#include "daemons/path_tracker/path_tracker_node.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace hairpin {
namespace {

// What no track and no car here can be: such a message is nonsense, not an extreme.
constexpr int kMaxPathPoints = 500;
constexpr double kMaxPathExtent = 200.0;  // m, from the car
constexpr double kMaxSpeed = 60.0;        // m/s
constexpr double kMaxYawRate = 15.0;      // rad/s

// Empty if the message can be used.
std::string ProblemOf(const track_t& message) {
  if (message.num_points < 2) return "a valid path has at least two points";
  if (message.num_points > kMaxPathPoints) return "too many points";
  for (const path_point_t& point : message.path) {
    if (std::hypot(point.x_m - message.x_m, point.y_m - message.y_m) > kMaxPathExtent) {
      return "a point is too far from the car";
    }
  }
  if (message.seen_length_m < 0.0 || message.seen_length_m > kMaxPathExtent) {
    return "seen_length_m is out of range";
  }
  return {};
}

std::string ProblemOf(const race_line_t& message) {
  if (message.num_points < 2) return "a line has at least two points";
  if (message.num_points > kMaxPathPoints) return "too many points";
  for (const race_line_point_t& point : message.points) {
    if (std::hypot(point.x_m - message.x_m, point.y_m - message.y_m) > kMaxPathExtent) {
      return "a point is too far from the car";
    }
    if (point.speed_mps < 0.0 || point.speed_mps > kMaxSpeed) return "a speed is out of range";
  }
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> covariance(
      message.pose_covariance);
  if (Eigen::LLT<Eigen::Matrix3d>(covariance).info() != Eigen::Success) {
    return "its covariance is not positive definite";
  }
  return {};
}

std::string ProblemOf(const velocity_t& message) {
  const double speed = std::hypot(message.vx_mps, message.vy_mps);
  if (speed > kMaxSpeed || std::abs(message.yaw_rate_radps) > kMaxYawRate) return "out of range";
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> covariance(
      message.covariance);
  if (Eigen::LLT<Eigen::Matrix3d>(covariance).info() != Eigen::Success) {
    return "its covariance is not positive definite";
  }
  return {};
}

PathInput ToPathInput(const track_t& message) {
  PathInput input;
  input.utime = message.utime;
  input.T_local_base = {message.x_m, message.y_m, message.yaw_rad};
  input.seen_length = message.seen_length_m;
  bool seen = true;
  for (const path_point_t& point : message.path) {
    input.points.emplace_back(point.x_m, point.y_m);
    input.widths.push_back(point.width_m);
    seen = seen && point.extrapolated == 0;
    if (seen) ++input.num_seen;
  }
  return input;
}

RaceLineInput ToRaceLineInput(const race_line_t& message) {
  RaceLineInput input;
  input.utime = message.utime;
  input.T_map_base = {message.x_m, message.y_m, message.yaw_rad};
  // Row-major; a sum of variances bounds that of the worst direction.
  input.position_sigma = std::sqrt(message.pose_covariance[0] + message.pose_covariance[4]);
  input.yaw_sigma = std::sqrt(message.pose_covariance[8]);
  for (const race_line_point_t& point : message.points) {
    input.points.emplace_back(point.x_m, point.y_m);
    input.speeds.push_back(point.speed_mps);
  }
  return input;
}

PipelineStatusInput ToInput(const pipeline_status_t& message) {
  const bool blind = message.map_mode <= pipeline_status_t::MODE_NONE ||
                     message.map_mode > pipeline_status_t::MODE_FUSION;
  return {message.utime, blind || message.level >= pipeline_status_t::LEVEL_CONTROLLED_STOP,
          message.speed_cap_mps};
}

int32_t ToMessage(DriveAction action) {
  switch (action) {
    case DriveAction::kHold:
      return drive_command_t::ACTION_HOLD;
    case DriveAction::kDrive:
      return drive_command_t::ACTION_DRIVE;
    case DriveAction::kStop:
      return drive_command_t::ACTION_STOP;
  }
  return drive_command_t::ACTION_UNKNOWN;
}

drive_command_t ToMessage(const TrackerCommand& command, int64_t utime) {
  drive_command_t message{};
  message.utime = utime;
  message.track_utime = command.path_utime;
  message.action = ToMessage(command.action);
  message.steering_angle_rad = command.steering_angle;
  std::copy(command.wheel_torque.begin(), command.wheel_torque.end(), message.wheel_torque_nm);
  message.brake = command.brake;
  message.target_speed_mps = command.target_speed;
  message.target_acceleration_mps2 = command.target_acceleration;
  message.lateral_error_m = command.lateral_error;
  message.on_race_line = command.on_race_line;
  return message;
}

void LoadSpeed(const Config& config, PathTrackerParams& params) {
  params.speed.max_speed = config.Number("max_speed_mps", {0.5, 40.0});
  params.speed.lateral_acceleration = config.Number("lateral_acceleration_mps2", {0.5, 20.0});
  params.speed.braking = config.Number("braking_mps2", {0.5, 20.0});
  params.speed.stop_margin = config.Number("stop_margin_m", {0.0, 5.0});
  params.reaction_time = config.Number("reaction_time_s", {0.0, 1.0});
  params.control.gain = config.Number("speed_gain_per_s", {0.1, 20.0});
  params.control.max_acceleration = config.Number("max_acceleration_mps2", {0.1, 20.0});
  params.control.max_braking = config.Number("max_braking_mps2", {0.5, 20.0});
  params.control.delay = config.Number("drive_delay_s", {0.0, 0.5});
  params.control.standstill_speed = config.Number("standstill_speed_mps", {0.01, 1.0});
  params.control.launch_speed = config.Number("launch_speed_mps", {0.02, 3.0});
  params.control.hold_brake = config.Number("hold_brake", {0.0, 1.0});
}

void LoadSteering(const Config& config, PathTrackerParams& params) {
  SteeringParams& steering = params.steering;
  steering.lookahead_time = config.Number("lookahead_time_s", {0.0, 2.0});
  steering.min_lookahead = config.Number("min_lookahead_m", {0.2, 10.0});
  steering.damping = config.Number("damping", {0.1, 2.0});
  steering.front_cornering_stiffness =
      config.Number("front_cornering_stiffness_n_per_rad", {1e3, 1e6});
  steering.rear_cornering_stiffness =
      config.Number("rear_cornering_stiffness_n_per_rad", {1e3, 1e6});
  steering.max_lateral_acceleration =
      config.Number("max_steering_lateral_acceleration_mps2", {0.5, 30.0});
  params.steering_delay = config.Number("steering_delay_s", {0.0, 0.5});
}

void LoadForces(const Config& config, PathTrackerParams& params) {
  WheelForcesParams& forces = params.forces;
  forces.drag = params.car.drag;
  forces.rolling_resistance = params.car.rolling_resistance;
  forces.grip = config.Number("grip_mps2", {1.0, 30.0});
  forces.min_braking = config.Number("min_braking_mps2", {0.0, 20.0});
  forces.max_regeneration = config.Number("max_regeneration_n", {0.0, 10000.0});
  forces.regeneration_fade_speed = config.Number("regeneration_fade_speed_mps", {0.01, 5.0});
  params.rates.steering = config.Number("steering_rate_radps", {0.1, 20.0});
  params.rates.torque = config.Number("torque_rate_nmps", {1.0, 1e5});
  params.rates.brake = config.Number("brake_rate_per_s", {0.1, 100.0});
}

// After all that the race line shares with the path.
void LoadRace(const Config& config, PathTrackerParams& params) {
  RaceGuideParams& race = params.race;
  race.path = params.path;
  race.path.max_length = config.Number("max_race_length_m", {20.0, 300.0});
  race.speed.max_speed = config.Number("race_max_speed_mps", {0.5, 40.0});
  // The line's own speeds decide; this bounds them by what the commands may ask of the tyres.
  race.speed.lateral_acceleration = params.forces.grip;
  race.speed.braking = params.control.max_braking;
  params.race_max_acceleration = config.Number("race_max_acceleration_mps2", {0.1, 20.0});
  race.speed.rise = params.race_max_acceleration;
  race.body_width = params.car.body_width;
  race.max_age = params.gate.max_data_age;
  race.max_position_sigma = config.Number("race_max_position_sigma_m", {0.01, 2.0});
  race.max_yaw_sigma = config.Number("race_max_yaw_sigma_rad", {0.001, 0.5});
  race.max_jump = config.Number("race_max_jump_m", {0.01, 2.0});
  race.overlap = config.Number("race_overlap_m", {0.0, 2.0});
  race.checked_length = config.Number("race_checked_length_m", {1.0, 50.0});
  race.healthy_for = config.Number("race_healthy_for_s", {0.0, 10.0});
  race.blend_time = config.Number("race_blend_s", {0.05, 5.0});
}

void LoadGate(const Config& config, PathTrackerParams& params) {
  params.gate.as_state_deadline = channels::kAsState.deadline_s;
  params.gate.pipeline_status_deadline = channels::kPipelineStatus.deadline_s;
  params.gate.max_data_age = config.Number("max_data_age_s", {0.05, 1.0});
  params.gate.max_path_age = config.Number("max_path_age_s", {0.05, 2.0});
  params.gate.stop_deceleration = config.Number("stop_deceleration_mps2", {0.5, 15.0});
  params.gate.finish_deceleration = config.Number("finish_deceleration_mps2", {0.5, 15.0});
  params.finish_distance = config.Number("finish_distance_m", {5.0, 30.0});
}

}  // namespace

PathTrackerParams LoadPathTrackerParams(const Config& config) {
  PathTrackerParams params;
  params.car = LoadCar(config);
  params.path.spacing = config.Number("path_spacing_m", {0.05, 2.0});
  params.path.smoothing_length = config.Number("path_smoothing_length_m", {0.0, 5.0});
  params.path.max_length = config.Number("max_path_length_m", {3.0, 200.0});
  LoadSpeed(config, params);
  LoadSteering(config, params);
  LoadForces(config, params);
  LoadGate(config, params);
  LoadRace(config, params);
  config.Finish();
  return params;
}

PathTrackerNode::PathTrackerNode(const PathTrackerParams& params, Bus& bus)
    : bus_(bus), tracker_(params) {
  bus.Subscribe(channels::kTrack, [this](const track_t& message) { OnTrack(message); });
  bus.Subscribe(channels::kRaceLine, [this](const race_line_t& message) { OnRaceLine(message); });
  bus.Subscribe(channels::kVelocity, [this](const velocity_t& message) { OnVelocity(message); });
  bus.Subscribe(channels::kAsState, [this](const as_state_t& message) {
    const bool driving = message.state == as_state_t::STATE_DRIVING;
    if (!tracker_.TakeAsState({message.utime, driving, message.mission_finished != 0})) {
      bus_.Refuse(channels::kAsState, "older than the last one");
    }
  });
  bus.Subscribe(channels::kPipelineStatus, [this](const pipeline_status_t& message) {
    if (!tracker_.TakePipelineStatus(ToInput(message))) {
      bus_.Refuse(channels::kPipelineStatus, "older than the last one");
    }
  });
}

void PathTrackerNode::OnTrack(const track_t& message) {
  if (message.valid == 0) return;  // the last path is kept while it is young enough
  std::string problem = ProblemOf(message);
  if (problem.empty()) problem = tracker_.TakePath(ToPathInput(message));
  if (!problem.empty()) bus_.Refuse(channels::kTrack, problem);
}

void PathTrackerNode::OnRaceLine(const race_line_t& message) {
  std::string problem = ProblemOf(message);
  if (problem.empty()) problem = tracker_.TakeRaceLine(ToRaceLineInput(message));
  if (!problem.empty()) bus_.Refuse(channels::kRaceLine, problem);
}

void PathTrackerNode::OnVelocity(const velocity_t& message) {
  const bool valid = message.valid != 0;
  const std::string problem = valid ? ProblemOf(message) : std::string();
  if (!problem.empty()) return bus_.Refuse(channels::kVelocity, problem);
  const Twist2 twist{message.vx_mps, message.vy_mps, message.yaw_rate_radps};
  const auto command = tracker_.Answer(message.utime, valid ? std::optional(twist) : std::nullopt);
  if (!command) return bus_.Refuse(channels::kVelocity, "time does not increase");
  bus_.Publish(channels::kDriveCommand, ToMessage(*command, message.utime));
}

}  // namespace hairpin
