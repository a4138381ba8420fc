#pragma once

#include <vector>

namespace hairpin {

/// What the car may do to its tyres, and what its motors can.
struct LapSpeedParams {
  double max_speed = 0.0;             // [m/s], > 0
  double lateral_acceleration = 0.0;  // without downforce [m/s2], > 0
  double braking = 0.0;               // [m/s2], > 0
  double acceleration = 0.0;          // [m/s2], > 0
  double mass = 0.0;                  // [kg], > 0
  double downforce = 0.0;             // per squared speed [N s2/m2], >= 0
  double drag = 0.0;                  // per squared speed [N s2/m2], >= 0
  double rolling_resistance = 0.0;    // [N], >= 0
  double max_power = 0.0;             // of the motors together [W], > 0
};

/// The highest speeds along a closed line [m/s], by point, within an ellipse of friction:
///
///     (v^2 k / (a_lat g))^2 + (a / (a_x g))^2 <= 1,    g = 1 + downforce v^2 / (9.81 m)
///     m a + drag v^2 + rolling <= P / v                while accelerating
///
/// with a_x the planned braking or acceleration. Corners first, then backward and forward over two
/// laps each, so that the lap closes [e.g. Heilmeier 2019, section 3.4; forward-backward solver,
/// Subosits and Gerdes 2015]. `curvature` [1/m] by point, `spacing` [m] apart. Throws
/// std::invalid_argument for parameters out of their bounds or fewer than three points.
std::vector<double> LapSpeeds(const std::vector<double>& curvature, double spacing,
                              const LapSpeedParams& params);

/// Time of a flying lap [s].
double LapTime(const std::vector<double>& speeds, double spacing);

}  // namespace hairpin
