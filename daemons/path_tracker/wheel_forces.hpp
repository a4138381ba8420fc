#pragma once

#include <array>

#include "common/car.hpp"

namespace hairpin {

struct WheelForcesParams {
  double drag = 0.0;                // force per squared speed [N s2/m2], >= 0
  double rolling_resistance = 0.0;  // [N], >= 0
  double grip = 0.0;                // of the tyres together, in any direction [m/s2], > 0
  double min_braking = 0.0;  // what is left for braking in the hardest corner [m/s2], 0 to grip
  double max_regeneration = 0.0;         // of all wheels together [N], >= 0
  double regeneration_fade_speed = 0.0;  // below it regeneration fades to nothing at 0 [m/s], > 0
};

/// What the motors and the friction brake are to do.
struct Actuation {
  std::array<double, 4> wheel_torque{};  // fl fr rl rr, at the wheel [Nm]; negative regenerates
  double brake = 0.0;                    // friction brake, 0 to 1
};

/// Turns an acceleration into torques and brake pressure: F = m a + c v^2 + F_roll, shared between
/// the axles by their load with the longitudinal load transfer m a h / L, so that both use the same
/// part of their grip. Braking regenerates as far as allowed, the friction brake does the rest.
class WheelForces {
 public:
  /// Throws std::invalid_argument for parameters out of their bounds.
  WheelForces(const WheelForcesParams& params, const Car& car);

  /// The acceleration that the friction circle leaves beside `lateral_acceleration`, no more than
  /// asked for [m/s2].
  double WithinGrip(double acceleration, double lateral_acceleration) const;
  /// Torques and brake for an `acceleration` [m/s2] at a `speed` [m/s].
  Actuation Distribute(double acceleration, double speed) const;

 private:
  double FrontLoadShare(double acceleration) const;

  WheelForcesParams params_;
  Car car_;
};

}  // namespace hairpin
