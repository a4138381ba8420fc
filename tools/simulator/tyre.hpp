#pragma once

#include <Eigen/Core>

namespace hairpin {

struct TyreParams {
  double stiffness_factor = 0.0;  // B
  double shape_factor = 0.0;      // C
  double peak_friction = 0.0;     // D at the nominal load
  double curvature_factor = 0.0;  // E
  double load_sensitivity = 0.0;  // share of friction lost when the load doubles
  double longitudinal_relaxation_m = 0.0;
  double lateral_relaxation_m = 0.0;
  double standstill_damping_nspm = 0.0;  // N s/m, of a tyre that does not roll
  double standstill_speed_mps = 0.0;     // where that damping has faded out
};

/// Tyre force by the magic formula with combined slip and relaxation. Slip is (kappa, tan alpha) in
/// the wheel's frame, with the sign of the force that it causes: positive pushes the car forward,
/// or left. Source: Pacejka, Tire and Vehicle Dynamics, 3rd ed., 4.3 (formula), 8.6 (single contact
/// point model, to standstill).
class Tyre {
 public:
  /// `nominal_load` [N]: where friction is peak_friction. Throws std::invalid_argument for values
  /// that cannot be.
  Tyre(const TyreParams& params, double nominal_load);

  /// Moves the contact patch on by `duration` [s]. `sliding`: velocity of the tread against the
  /// road with reversed sign [m/s], (omega R - v_x, -v_y); `rolling_speed`: |v_x| of the hub [m/s].
  void Step(const Eigen::Vector2d& sliding, double rolling_speed, double duration);

  /// Force on the car, forward and left in the wheel's frame [N], under `load` [N].
  Eigen::Vector2d Force(double load) const;

  /// Friction coefficient at `load` [N].
  double Friction(double load) const;
  const Eigen::Vector2d& slip() const { return slip_; }

 private:
  TyreParams params_;
  double nominal_load_;
  Eigen::Vector2d slip_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d damping_force_ = Eigen::Vector2d::Zero();
};

}  // namespace hairpin
