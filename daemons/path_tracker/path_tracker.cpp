#include "daemons/path_tracker/path_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/clock.hpp"
#include "common/require.hpp"

namespace hairpin {
namespace {

// The place on the path is looked for about the last one: a hairpin's other leg may be nearer in
// space.
constexpr double kSearchBehind = 1.0;  // m
constexpr double kSearchAhead =
    6.0;  // m: 12 m/s for the greatest age of a path, and more than a period
constexpr double kMaxStep = 0.1;  // s: no command grows for longer than this at once

void Check(const PathTrackerParams& params) {
  constexpr Require require("PathTracker");
  const SpeedControlParams& control = params.control;
  require(control.gain > 0.0, "speed_gain_per_s must be > 0");
  require(control.max_acceleration > 0.0, "max_acceleration_mps2 must be > 0");
  require(control.max_braking >= params.speed.braking, "max_braking_mps2 must be >= braking_mps2");
  require(control.delay >= 0.0, "drive_delay_s must be >= 0");
  require(control.standstill_speed > 0.0, "standstill_speed_mps must be > 0");
  require(control.launch_speed > control.standstill_speed,
          "launch_speed_mps must be > standstill_speed_mps");
  require(control.hold_brake >= 0.0 && control.hold_brake <= 1.0, "hold_brake must be from 0 to 1");
  require(params.rates.steering > 0.0, "steering_rate_radps must be > 0");
  require(params.rates.torque > 0.0, "torque_rate_nmps must be > 0");
  require(params.rates.brake > 0.0, "brake_rate_per_s must be > 0");
  require(params.reaction_time >= 0.0, "reaction_time_s must be >= 0");
  require(params.steering_delay >= 0.0, "steering_delay_s must be >= 0");
  require(params.race_max_acceleration >= control.max_acceleration,
          "race_max_acceleration_mps2 must be >= max_acceleration_mps2");
  require(params.finish_distance > 0.0, "finish_distance_m must be > 0");
  Check(params.gate);
}

// Toward `wanted`, with the magnitude growing by at most `most`; letting go is immediate.
double Grow(double from, double wanted, double most) {
  if (from * wanted < 0.0) from = 0.0;
  const double limit = std::abs(from) + most;
  return std::clamp(wanted, -limit, limit);
}

// How fast a target falls that is read `lead` seconds ahead on a profile with the slope
// `acceleration`: the time derivative of v = p(s + v lead), that is v' = a (1 + v' lead / v).
double Falling(double acceleration, double speed, double lead) {
  return speed > 0.0 ? acceleration / (1.0 - acceleration * lead / speed) : 0.0;
}

}  // namespace

PathTracker::PathTracker(const PathTrackerParams& params)
    : params_(params),
      steering_(params.steering, params.car),
      forces_(params.forces, params.car),
      history_(params.gate.max_path_age + PoseHistory::kMaxExtrapolation),
      race_(params.race) {
  Check(params);
  // Refuses wrong parameters of the parts that are made anew for each path.
  const ReferencePath path({{0.0, 0.0}, {1.0, 0.0}}, params.path);
  SpeedProfile(path.curvature(), path.spacing(), path.length(), params.speed);
  SpeedProfile(path.curvature(), path.spacing(), path.length(), params.race.speed);
  last_.brake = params.control.hold_brake;
}

std::string PathTracker::TakePath(const PathInput& input) {
  if (followed_ && input.utime <= followed_->utime) return "no newer than the last path";
  if (SecondsBetween(input.utime, history_.newest_utime()) > params_.gate.max_data_age) {
    return "too old to drive on";
  }
  const std::optional<Pose2> T_own_base = history_.At(input.utime);
  if (!T_own_base) return "its time is outside the pose history";
  const Pose2 T_own_local = *T_own_base * input.T_local_base.Inverse();
  std::vector<Eigen::Vector2d> points;
  points.reserve(input.points.size() + 1);
  // A path that begins ahead is joined to the car.
  const Eigen::Vector2d base = T_own_base->position();
  if (!input.points.empty() &&
      (T_own_local * input.points[0] - base).norm() > params_.path.spacing) {
    points.push_back(base);
  }
  for (const Eigen::Vector2d& point : input.points) points.push_back(T_own_local * point);
  try {
    ReferencePath path(points, params_.path);
    const double seen = SeenLength(path, input, T_own_local);
    SpeedProfile profile(path.curvature(), path.spacing(), seen, params_.speed);
    followed_.emplace(Followed{input.utime, std::move(path), std::move(profile), 0.0});
    CompareRaceLine(input, T_own_local);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

std::string PathTracker::TakeRaceLine(const RaceLineInput& line) {
  const std::optional<Pose2> T_own_base = history_.At(line.utime);
  const std::optional<Pose2> T_own_now = history_.At(history_.newest_utime());
  if (!T_own_base || !T_own_now) return "its time is outside the pose history";
  return race_.Take(line, *T_own_base, *T_own_now);
}

void PathTracker::CompareRaceLine(const PathInput& input, const Pose2& T_own_local) {
  SeenTrack seen;
  seen.utime = input.utime;
  seen.path = &followed_->path;
  for (size_t i = 0; i < std::min(input.num_seen, input.widths.size()); ++i) {
    seen.points.push_back(T_own_local * input.points[i]);
    seen.widths.push_back(input.widths[i]);
  }
  race_.Compare(seen);
}

double PathTracker::SeenLength(const ReferencePath& path, const PathInput& input,
                               const Pose2& T_own_local) const {
  if (input.num_seen == 0) return 0.0;
  const Eigen::Vector2d last = T_own_local * input.points[input.num_seen - 1];
  const double stated = std::max(input.seen_length, 0.0);
  // Smoothing shortens a path: both the stated length and the place of the last seen point bound
  // it.
  const double placed = path.Locate(last, stated - kSearchAhead, stated + kSearchBehind).s;
  return std::clamp(placed, 0.0, stated);
}

bool PathTracker::TakeAsState(const AsStateInput& as_state) {
  if (as_state_ && as_state.utime < as_state_->utime) return false;
  as_state_ = as_state;
  if (!as_state.mission_finished) finish_deceleration_.reset();
  if (as_state.mission_finished && !finish_deceleration_) {
    const double needed = 0.5 * twist_.vx * twist_.vx / params_.finish_distance;
    finish_deceleration_ =
        std::clamp(needed, params_.gate.finish_deceleration,
                   std::max(params_.control.max_braking, params_.gate.finish_deceleration));
  }
  return true;
}

bool PathTracker::TakePipelineStatus(const PipelineStatusInput& status) {
  if (status_ && status.utime < status_->utime) return false;
  status_ = status;
  return true;
}

ReferencePath::Location PathTracker::LocateOnPath(const Pose2& T_own_base) const {
  const double s = followed_->progress;
  return followed_->path.Locate(T_own_base.position(), s - kSearchBehind, s + kSearchAhead);
}

ReferencePath::Location PathTracker::Locate(const Pose2& T_own_base) const {
  ReferencePath::Location location = LocateOnPath(T_own_base);
  const double w = race_.weight();
  if (w <= 0.0) return location;
  const ReferencePath::Location race = race_.Locate(T_own_base.position());
  location.lateral_error = std::lerp(location.lateral_error, race.lateral_error, w);
  location.heading += w * WrapAngle(race.heading - location.heading);
  location.curvature = std::lerp(location.curvature, race.curvature, w);
  return location;
}

double PathTracker::Steer(const Pose2& T_own_base) const {
  // The wheels answer late: steer for the place where the car will be by then.
  const Pose2 T_own_then = T_own_base * Integrate(twist_, params_.steering_delay);
  return steering_.Angle(Locate(T_own_then), T_own_then.yaw, std::max(twist_.vx, 0.0));
}

SpeedProfile::Limit PathTracker::PathSpeed(int64_t utime) const {
  const double speed = std::max(twist_.vx, 0.0);
  const double s = followed_->progress;
  const double delay = params_.control.delay;
  SpeedProfile::Limit target = followed_->profile.Corners(s + speed * delay);
  target.acceleration = Falling(target.acceleration, speed, delay);

  const double waiting = params_.reaction_time - SecondsBetween(followed_->utime, utime);
  const double lead = std::max(waiting, delay);
  SpeedProfile::Limit stop = followed_->profile.Stop(s + speed * lead);
  // While waiting for the next path the place read stands still, and the target with it.
  stop.acceleration = waiting > delay ? 0.0 : Falling(stop.acceleration, speed, lead);
  if (stop.speed < target.speed) target = stop;
  return target;
}

SpeedProfile::Limit PathTracker::RaceSpeed() const {
  return race_.Speed(std::max(twist_.vx, 0.0) * params_.control.delay);
}

SpeedProfile::Limit PathTracker::TargetSpeed(int64_t utime) const {
  if (race_.leads()) return RaceSpeed();
  const SpeedProfile::Limit target = PathSpeed(utime);
  if (race_.weight() <= 0.0) return target;
  const SpeedProfile::Limit race = RaceSpeed();
  return race.speed < target.speed ? race : target;
}

double PathTracker::Accelerate(const DriveDecision& decision,
                               const std::optional<SpeedProfile::Limit>& target) const {
  const SpeedControlParams& control = params_.control;
  const double most = race_.leads() ? params_.race_max_acceleration : control.max_acceleration;
  double acceleration = decision.may_accelerate ? most : 0.0;
  if (decision.action != DriveAction::kDrive) acceleration = -decision.deceleration;
  if (target) {
    const double tracking = target->acceleration + control.gain * (target->speed - twist_.vx);
    acceleration = std::clamp(tracking, -control.max_braking, acceleration);
  }
  return forces_.WithinGrip(acceleration, twist_.vx * twist_.yaw_rate);
}

bool PathTracker::Stands(const DriveDecision& decision, double target_speed) const {
  if (std::abs(twist_.vx) >= params_.control.standstill_speed) return false;
  return decision.action != DriveAction::kDrive || !decision.may_accelerate ||
         target_speed < params_.control.launch_speed;
}

Actuation PathTracker::Actuate(const TrackerCommand& command, bool stands,
                               bool velocity_valid) const {
  Actuation actuation;
  if (stands) {
    actuation.brake = params_.control.hold_brake;
  } else if (command.action == DriveAction::kHold || !velocity_valid) {
    // The motors may be off, or the speed unknown: friction alone.
    const double force = -params_.car.mass * command.target_acceleration;
    actuation.brake = std::clamp(force / params_.car.max_brake_force, 0.0, 1.0);
  } else {
    actuation = forces_.Distribute(command.target_acceleration, twist_.vx);
  }
  return actuation;
}

void PathTracker::LimitRates(TrackerCommand& command, double dt) const {
  const double turn = params_.rates.steering * dt;
  command.steering_angle =
      std::clamp(command.steering_angle, last_.steering_angle - turn, last_.steering_angle + turn);
  for (size_t i = 0; i < command.wheel_torque.size(); ++i) {
    command.wheel_torque[i] =
        Grow(last_.wheel_torque[i], command.wheel_torque[i], params_.rates.torque * dt);
  }
  command.brake = Grow(last_.brake, command.brake, params_.rates.brake * dt);
}

std::optional<SpeedProfile::Limit> PathTracker::Follow(const DriveDecision& decision, int64_t utime,
                                                       TrackerCommand& command) {
  const std::optional<Pose2> T_own_base = history_.At(utime);
  if (!followed_ || !T_own_base) return std::nullopt;
  followed_->progress = LocateOnPath(*T_own_base).s;
  race_.Update(utime, *T_own_base, followed_->utime);
  command.on_race_line = race_.leads();
  command.path_utime = race_.leads() ? race_.line_utime() : followed_->utime;
  command.lateral_error = Locate(*T_own_base).lateral_error;
  const bool drives = decision.action == DriveAction::kDrive;
  // Wheels are not turned where the car waits.
  if (drives || twist_.vx > params_.control.standstill_speed)
    command.steering_angle = Steer(*T_own_base);
  SpeedProfile::Limit target = TargetSpeed(utime);
  if (drives && status_->speed_cap < target.speed)
    target = {std::max(status_->speed_cap, 0.0), 0.0};
  if (drives) command.target_speed = target.speed;
  return target;
}

std::optional<TrackerCommand> PathTracker::Answer(int64_t utime,
                                                  const std::optional<Twist2>& velocity) {
  if (utime <= last_utime_) return std::nullopt;
  const double dt = last_utime_ == 0 ? 0.0 : std::min(SecondsBetween(last_utime_, utime), kMaxStep);
  if (velocity) {
    history_.Add(utime, *velocity);
    twist_ = *velocity;
  }
  const std::optional<int64_t> path_utime =
      followed_ ? std::optional(followed_->utime) : std::nullopt;
  DriveGateParams gate = params_.gate;
  gate.finish_deceleration = finish_deceleration_.value_or(gate.finish_deceleration);
  const DriveDecision decision =
      Decide({utime, velocity.has_value(), as_state_, status_, path_utime}, gate);
  TrackerCommand command;
  command.action = decision.action;
  command.steering_angle = last_.steering_angle;  // kept where there is nothing better
  std::optional<SpeedProfile::Limit> target;
  if (velocity) target = Follow(decision, utime, command);
  const bool stands = Stands(decision, command.target_speed);
  command.target_acceleration = stands ? 0.0 : Accelerate(decision, target);
  const Actuation actuation = Actuate(command, stands, velocity.has_value());
  command.wheel_torque = actuation.wheel_torque;
  command.brake = actuation.brake;
  LimitRates(command, dt);
  last_ = command;
  last_utime_ = utime;
  return command;
}

}  // namespace hairpin
