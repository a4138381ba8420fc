#pragma once

#include <Eigen/Core>
#include <vector>

namespace hairpin {

struct ReferencePathParams {
  double spacing = 0.0;           // of the samples [m], > 0
  double smoothing_length = 0.0;  // [m], >= 0; 0: none
  double max_length = 0.0;        // what lies beyond is cut off [m], > spacing
};

/// A smooth curve through noisy points, with heading and curvature by arc length. Built once for
/// each path; looking something up in it is cheap.
///
/// The points are resampled evenly and smoothed with a discrete smoothing spline, the minimum of
/// sum |q_i - p_i|^2 + (l / h)^6 sum |q_(i+3) - 3 q_(i+2) + 3 q_(i+1) - q_i|^2 [Whittaker 1923;
/// Eilers 2003, "A perfect smoother"], with l the smoothing length and h the spacing: a wave of
/// wavelength w keeps 1 / (1 + (2 pi l / w)^6) of its height, a circle of radius r 1 / (1 + (l /
/// r)^6). Third differences leave the curvature free at the ends: the car drives near the start of
/// each path.
class ReferencePath {
 public:
  /// `points` in driving order, in any fixed frame [m]. Throws std::invalid_argument unless two of
  /// them are apart by more than the hundredth part of `spacing`, and for parameters out of their
  /// bounds.
  ReferencePath(const std::vector<Eigen::Vector2d>& points, const ReferencePathParams& params);

  /// Where a point lies along the path. Before the start and past the end the path goes on
  /// straight.
  struct Location {
    double s = 0.0;              // arc length from the start [m]; negative before it
    double lateral_error = 0.0;  // [m], positive: the point is left of the path
    double heading = 0.0;        // of the path there [rad]
    double curvature = 0.0;      // of the path there [1/m], positive to the left
  };
  /// The nearest place with an arc length from `s_min` to `s_max`, in the frame of the points.
  Location Locate(const Eigen::Vector2d& point, double s_min, double s_max) const;

  /// The place at arc length `s`, at an end's where it lies beyond.
  Eigen::Vector2d PointAt(double s) const;

  double spacing() const { return spacing_; }
  double length() const { return spacing_ * static_cast<double>(points_.size() - 1); }
  /// By sample, `spacing()` apart, from the start [1/m].
  const std::vector<double>& curvature() const { return curvature_; }

 private:
  Location At(const Eigen::Vector2d& point, size_t segment, double along) const;

  double spacing_;
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> heading_;  // continuous: not wrapped
  std::vector<double> curvature_;
};

}  // namespace hairpin
