#include "daemons/path_tracker/wheel_forces.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr double kGravity = 9.81;  // m/s2

void Check(const WheelForcesParams& params) {
  constexpr Require require("WheelForces");
  require(params.drag >= 0.0, "drag_n_per_mps2 must be >= 0");
  require(params.rolling_resistance >= 0.0, "rolling_resistance_n must be >= 0");
  require(params.grip > 0.0, "grip_mps2 must be > 0");
  require(params.min_braking >= 0.0 && params.min_braking <= params.grip,
          "min_braking_mps2 must be from 0 to grip_mps2");
  require(params.max_regeneration >= 0.0, "max_regeneration_n must be >= 0");
  require(params.regeneration_fade_speed > 0.0, "regeneration_fade_speed_mps must be > 0");
}

}  // namespace

WheelForces::WheelForces(const WheelForcesParams& params, const Car& car)
    : params_(params), car_(car) {
  Check(params);
}

double WheelForces::WithinGrip(double acceleration, double lateral_acceleration) const {
  const double left = params_.grip * params_.grip - lateral_acceleration * lateral_acceleration;
  const double most = std::max(std::sqrt(std::max(left, 0.0)), params_.min_braking);
  return std::clamp(acceleration, -most, most);
}

double WheelForces::FrontLoadShare(double acceleration) const {
  const double transfer = acceleration * car_.cog_height / kGravity;
  return std::clamp((car_.rear_axle - transfer) / car_.wheelbase(), 0.0, 1.0);
}

Actuation WheelForces::Distribute(double acceleration, double speed) const {
  const double resistance = params_.drag * speed * std::abs(speed) + params_.rolling_resistance;
  const double force = car_.mass * acceleration + resistance;
  const double share = FrontLoadShare(acceleration);
  double front = force * share;
  double rear = force * (1.0 - share);
  Actuation actuation;
  if (force < 0.0) {
    const double fade = std::clamp(speed / params_.regeneration_fade_speed, 0.0, 1.0);
    const double friction = std::max(0.0, -force - fade * params_.max_regeneration);
    actuation.brake = std::min(friction / car_.max_brake_force, 1.0);
    // The friction brake's balance is fixed; regeneration makes up what an axle lacks.
    front = std::min(0.0, front + friction * car_.front_brake_share);
    rear = std::min(0.0, rear + friction * (1.0 - car_.front_brake_share));
  }
  const double to_torque = 0.5 * car_.wheel_radius;  // of one wheel, for the force of an axle
  const double most = car_.max_wheel_torque;
  const double front_torque = std::clamp(front * to_torque, -most, most);
  const double rear_torque = std::clamp(rear * to_torque, -most, most);
  actuation.wheel_torque = {front_torque, front_torque, rear_torque, rear_torque};
  return actuation;
}

}  // namespace hairpin
