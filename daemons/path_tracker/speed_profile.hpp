#pragma once

#include <cstddef>
#include <vector>

namespace hairpin {

struct SpeedProfileParams {
  double max_speed = 0.0;             // [m/s], > 0
  double lateral_acceleration = 0.0;  // planned in corners [m/s2], > 0
  double braking = 0.0;               // planned deceleration [m/s2], > 0
  double stop_margin = 0.0;           // stand this far before the end of what was seen [m], >= 0
  double rise = 0.0;  // acceleration of the profile that is told as such, no more [m/s2], >= 0
};

/// The highest speeds along a path that its curvature, the friction circle and the end of the seen
/// stretch allow. Built once for each path.
///
/// A sample with curvature k allows v^2 <= a_lat / |k|. Going backward from the end,
/// v_i^2 <= v_(i+1)^2 + 2 a_x h with a_x = a_brake sqrt(1 - (v_(i+1)^2 k_(i+1) / a_lat)^2), what
/// the friction circle leaves beside cornering (forward-backward solver, e.g. [Subosits and Gerdes
/// 2015]).
class SpeedProfile {
 public:
  /// `curvature` [1/m] by sample, `spacing` [m] apart; `seen_length` [m] is the part from the start
  /// that cones support. Throws std::invalid_argument for parameters out of their bounds, fewer
  /// than two samples, spacing or length not > 0.
  SpeedProfile(const std::vector<double>& curvature, double spacing, double seen_length,
               const SpeedProfileParams& params);
  /// The same with a speed planned for each sample, which is never exceeded [m/s], and no end: the
  /// plan goes on beyond it. Throws too where there are not as many speeds as samples.
  SpeedProfile(const std::vector<double>& curvature, double spacing,
               const std::vector<double>& planned, const SpeedProfileParams& params);

  /// Speed at a place, and the deceleration with which the profile falls there; or the acceleration
  /// with which it rises, up to `rise`.
  struct Limit {
    double speed = 0.0;         // [m/s]
    double acceleration = 0.0;  // [m/s2]
  };
  /// What the corners ahead allow at arc length `s` [m]; the path's end is no limit here.
  Limit Corners(double s) const { return At(corners_, s); }
  /// The same, and the car can stand `stop_margin` before the end of the seen stretch: 0 from there
  /// on.
  Limit Stop(double s) const;

 private:
  void LimitCorners();
  void BrakeBackward(std::vector<double>& squared_speed, size_t from) const;
  Limit At(const std::vector<double>& squared_speed, double s) const;

  SpeedProfileParams params_;
  double spacing_;
  double stop_at_;  // arc length [m]
  std::vector<double> curvature_;
  // Squared speeds by sample: linear in s where the acceleration is constant. stop_ crosses zero at
  // stop_at_.
  std::vector<double> corners_;
  std::vector<double> stop_;
};

}  // namespace hairpin
