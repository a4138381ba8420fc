#pragma once

#include "common/car.hpp"
#include "daemons/path_tracker/reference_path.hpp"

namespace hairpin {

struct SteeringParams {
  double lookahead_time = 0.0;             // [s], >= 0
  double min_lookahead = 0.0;              // [m], > 0
  double damping = 0.0;                    // of the error's decay, 1: aperiodic; > 0
  double front_cornering_stiffness = 0.0;  // both wheels together [N/rad], > 0
  double rear_cornering_stiffness = 0.0;   // [N/rad], > 0
  double max_lateral_acceleration = 0.0;   // never steer for more than this [m/s2], > 0
};

/// Path following by feed-forward of the path's curvature and feedback of the error at a point
/// ahead [Kapania and Gerdes 2015, "Design of a feedback-feedforward steering controller for
/// accurate path tracking and stability at the limits of handling", eqs. 2, 5, 13]:
///
///     delta = delta_ff - k (e + x_la sin(psi + beta - psi_path))
///     delta_ff = atan(L / l_r tan(beta_kin)) + K_us v^2 kappa,  beta_kin = asin(l_r kappa)
///     beta = beta_kin - m l_f / (L C_r) v^2 kappa                 the sideslip of steady cornering
///     K_us = m / L (l_r / C_f - l_f / C_r)                        understeer gradient
///
/// The lookahead x_la grows with speed. With k = 4 zeta^2 L / x_la^2 the lateral error of a
/// kinematic bicycle decays along the path as a second-order system of damping zeta and natural
/// frequency 2 zeta / x_la [1/m]; zeta = 0.71 is as stiff as pure pursuit of a point x_la ahead,
/// without its cutting of corners.
class SteeringLaw {
 public:
  /// Throws std::invalid_argument for parameters out of their bounds.
  SteeringLaw(const SteeringParams& params, const Car& car);

  /// Angle of the front wheels [rad], positive to the left, within the car's limit. `location` is
  /// where base is on the path, `yaw` its direction in the path's frame, `speed` >= 0 [m/s].
  double Angle(const ReferencePath::Location& location, double yaw, double speed) const;

 private:
  double SteadySideslip(double curvature, double speed) const;
  double SteadyAngle(double curvature, double speed) const;

  SteeringParams params_;
  Car car_;
  double understeer_gradient_;  // [rad per m/s2]
  double rear_slip_gradient_;   // [rad per m/s2]
};

}  // namespace hairpin
