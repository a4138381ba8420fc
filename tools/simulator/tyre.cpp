#include "tools/simulator/tyre.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/require.hpp"

namespace hairpin {
namespace {

// A locked wheel has slip -1. Nothing changes past it but the depth of a spring that would have to
// unwind.
constexpr double kMaxSlip = 1.0;
constexpr double kMinSlip = 1e-9;  // below, a direction cannot be told, and there is no force
constexpr double kMaxLoadRatio =
    4.0;  // of the nominal load: beyond, the linear loss of friction is no model

}  // namespace

Tyre::Tyre(const TyreParams& params, double nominal_load)
    : params_(params), nominal_load_(nominal_load) {
  RequirePositive("tyre.stiffness_factor", params.stiffness_factor);
  RequireWithin("tyre.shape_factor", params.shape_factor, 1.0, 2.0);
  RequirePositive("tyre.peak_friction", params.peak_friction);
  RequireWithin("tyre.curvature_factor", params.curvature_factor, -10.0, 1.0);
  RequireWithin("tyre.load_sensitivity", params.load_sensitivity, 0.0, 1.0 / kMaxLoadRatio);
  RequirePositive("tyre.longitudinal_relaxation", params.longitudinal_relaxation_m);
  RequirePositive("tyre.lateral_relaxation", params.lateral_relaxation_m);
  RequireNotNegative("tyre.standstill_damping", params.standstill_damping_nspm);
  RequirePositive("tyre.standstill_speed", params.standstill_speed_mps);
  RequirePositive("tyre.nominal_load", nominal_load);
}

void Tyre::Step(const Eigen::Vector2d& sliding, double rolling_speed, double duration) {
  // sigma u' + |v_x| u = sliding, implicit in u: stable at any speed, a spring at standstill.
  const Eigen::Array2d relaxation(params_.longitudinal_relaxation_m, params_.lateral_relaxation_m);
  slip_ = ((relaxation * slip_.array() + duration * sliding.array()) /
           (relaxation + duration * rolling_speed))
              .matrix();
  const double length = slip_.norm();
  if (length > kMaxSlip) slip_ *= kMaxSlip / length;
  const double share = std::min(rolling_speed / params_.standstill_speed_mps, 1.0);
  const double damping =
      0.5 * params_.standstill_damping_nspm * (1.0 + std::cos(std::numbers::pi * share));
  damping_force_ = damping * sliding;
}

double Tyre::Friction(double load) const {
  const double ratio = std::clamp(load / nominal_load_, 0.0, kMaxLoadRatio);
  return params_.peak_friction * (1.0 - params_.load_sensitivity * (ratio - 1.0));
}

Eigen::Vector2d Tyre::Force(double load) const {
  if (!(load > 0.0)) return Eigen::Vector2d::Zero();
  const double peak = Friction(load) * load;
  const double slip_stiffness = params_.stiffness_factor * params_.shape_factor * peak;
  // Damping enters as slip, so that it never exceeds the friction there is.
  const Eigen::Vector2d slip = slip_ + damping_force_ / slip_stiffness;
  const double length = slip.norm();
  if (length < kMinSlip) return Eigen::Vector2d::Zero();
  // F = D sin(C atan(B s - E (B s - atan(B s)))), along the combined slip.
  const double bs = params_.stiffness_factor * length;
  const double bent = bs - params_.curvature_factor * (bs - std::atan(bs));
  return slip * (peak * std::sin(params_.shape_factor * std::atan(bent)) / length);
}

}  // namespace hairpin
