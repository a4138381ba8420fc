#include "daemons/path_tracker/steering.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/require.hpp"

namespace hairpin {
namespace {

void Check(const SteeringParams& params) {
  constexpr Require require("SteeringLaw");
  require(params.lookahead_time >= 0.0, "lookahead_time_s must be >= 0");
  require(params.min_lookahead > 0.0, "min_lookahead_m must be > 0");
  require(params.damping > 0.0, "damping must be > 0");
  require(params.front_cornering_stiffness > 0.0,
          "front_cornering_stiffness_n_per_rad must be > 0");
  require(params.rear_cornering_stiffness > 0.0, "rear_cornering_stiffness_n_per_rad must be > 0");
  require(params.max_lateral_acceleration > 0.0, "max_lateral_acceleration_mps2 must be > 0");
}

// A tighter circle than this no steering reaches; asin() needs a bound.
constexpr double kMaxSineOfSideslip = 0.9;

}  // namespace

SteeringLaw::SteeringLaw(const SteeringParams& params, const Car& car)
    : params_(params), car_(car) {
  Check(params);
  const double L = car.wheelbase();
  understeer_gradient_ = car.mass / L *
                         (car.rear_axle / params.front_cornering_stiffness -
                          car.front_axle / params.rear_cornering_stiffness);
  rear_slip_gradient_ = car.mass * car.front_axle / (L * params.rear_cornering_stiffness);
}

double SteeringLaw::SteadySideslip(double curvature, double speed) const {
  const double sine =
      std::clamp(car_.rear_axle * curvature, -kMaxSineOfSideslip, kMaxSineOfSideslip);
  return std::asin(sine) - rear_slip_gradient_ * speed * speed * curvature;
}

double SteeringLaw::SteadyAngle(double curvature, double speed) const {
  const double sine =
      std::clamp(car_.rear_axle * curvature, -kMaxSineOfSideslip, kMaxSineOfSideslip);
  return std::atan(car_.wheelbase() / car_.rear_axle * std::tan(std::asin(sine))) +
         understeer_gradient_ * speed * speed * curvature;
}

double SteeringLaw::Angle(const ReferencePath::Location& location, double yaw, double speed) const {
  const double lookahead = std::max(params_.min_lookahead, params_.lookahead_time * speed);
  const double gain =
      4.0 * params_.damping * params_.damping * car_.wheelbase() / (lookahead * lookahead);
  // The speed profile keeps v^2 kappa below this; the bound is for a car that comes in too fast.
  const double sharpest =
      params_.max_lateral_acceleration / std::max(speed * speed, 1.0 /* m2/s2, any small one */);
  const double curvature = std::clamp(location.curvature, -sharpest, sharpest);
  const double course = yaw + SteadySideslip(curvature, speed);
  const double error = location.lateral_error + lookahead * std::sin(course - location.heading);
  const double angle = SteadyAngle(curvature, speed) - gain * error;
  const double limit =
      std::min(car_.max_steering_angle, SteadyAngle(sharpest, speed) +
                                            rear_slip_gradient_ * params_.max_lateral_acceleration);
  return std::clamp(angle, -limit, limit);
}

}  // namespace hairpin
