#include "daemons/global_mapper/race_line/lap_speed.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr double kGravity = 9.81;  // m/s2

void Check(const LapSpeedParams& params) {
  constexpr Require require("LapSpeeds");
  require(params.max_speed > 0.0, "max_speed_mps must be > 0");
  require(params.lateral_acceleration > 0.0, "lateral_acceleration_mps2 must be > 0");
  require(params.braking > 0.0, "braking_mps2 must be > 0");
  require(params.acceleration > 0.0, "acceleration_mps2 must be > 0");
  require(params.mass > 0.0, "mass_kg must be > 0");
  require(params.downforce >= 0.0, "downforce_n_per_mps2 must be >= 0");
  require(params.drag >= 0.0, "drag_n_per_mps2 must be >= 0");
  require(params.rolling_resistance >= 0.0, "rolling_resistance_n must be >= 0");
  require(params.max_power > 0.0, "max_motor_power_w must be > 0");
}

double Grip(double squared, const LapSpeedParams& params) {
  return 1.0 + params.downforce * squared / (kGravity * params.mass);
}

// Share of the longitudinal limit that cornering leaves.
double Left(double squared, double curvature, const LapSpeedParams& params) {
  const double used = squared * curvature / (params.lateral_acceleration * Grip(squared, params));
  return std::sqrt(std::max(0.0, 1.0 - used * used));
}

// v^2 |k| = a_lat (1 + c v^2), solved for v^2.
double Corner(double curvature, const LapSpeedParams& params) {
  const double most = params.max_speed * params.max_speed;
  const double carried = params.lateral_acceleration * params.downforce / (kGravity * params.mass);
  const double bend = std::abs(curvature) - carried;
  return bend * most > params.lateral_acceleration ? params.lateral_acceleration / bend : most;
}

double Acceleration(double squared, double curvature, const LapSpeedParams& params) {
  const double by_tyres =
      params.acceleration * Grip(squared, params) * Left(squared, curvature, params);
  const double resistance = params.drag * squared + params.rolling_resistance;
  const double speed = std::sqrt(std::max(squared, 1e-6));
  const double by_motors = (params.max_power / speed - resistance) / params.mass;
  return std::min(by_tyres, by_motors);
}

}  // namespace

std::vector<double> LapSpeeds(const std::vector<double>& curvature, double spacing,
                              const LapSpeedParams& params) {
  Check(params);
  if (curvature.size() < 3 || !(spacing > 0.0)) {
    throw std::invalid_argument("LapSpeeds: needs three points and spacing > 0");
  }
  const size_t n = curvature.size();
  std::vector<double> squared;
  squared.reserve(n);
  for (const double k : curvature) squared.push_back(Corner(k, params));
  for (size_t step = 2 * n; step-- > 0;) {
    const size_t here = step % n;
    const size_t next = (step + 1) % n;
    const double braking =
        params.braking * Grip(squared[next], params) * Left(squared[next], curvature[next], params);
    squared[here] = std::min(squared[here], squared[next] + 2.0 * braking * spacing);
  }
  for (size_t step = 0; step < 2 * n; ++step) {
    const size_t here = step % n;
    const size_t next = (step + 1) % n;
    const double acceleration = Acceleration(squared[here], curvature[here], params);
    squared[next] = std::min(squared[next], squared[here] + 2.0 * acceleration * spacing);
  }
  std::vector<double> speeds;
  speeds.reserve(n);
  for (const double v2 : squared) speeds.push_back(std::sqrt(std::max(v2, 0.0)));
  return speeds;
}

double LapTime(const std::vector<double>& speeds, double spacing) {
  double time = 0.0;
  for (size_t i = 0; i < speeds.size(); ++i)
    time += 2.0 * spacing / (speeds[i] + speeds[(i + 1) % speeds.size()]);
  return time;
}

}  // namespace hairpin
