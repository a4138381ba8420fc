#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace hairpin {

using Points = std::vector<Eigen::Vector2d>;

/// A closed curve through points evenly spaced along it, in map [m]; the last point is followed by
/// the first. Headings and curvatures by central differences of the chords.
class ClosedCurve {
 public:
  /// Resamples the closed polyline through `points` to about `spacing` [m]. Throws
  /// std::invalid_argument for fewer than three points, spacing not > 0, or a polyline shorter than
  /// ten times the spacing.
  ClosedCurve(const Points& points, double spacing);

  size_t size() const { return points_.size(); }
  const Points& points() const { return points_; }
  /// Between neighbours, along the polyline that was resampled [m].
  double spacing() const { return spacing_; }
  double length() const { return spacing_ * static_cast<double>(size()); }

  /// Unit vector to the left of the driving direction at point `i`.
  const Eigen::Vector2d& normal(size_t i) const { return normals_[i]; }
  /// By point [1/m], positive to the left.
  const std::vector<double>& curvature() const { return curvature_; }
  /// Integral of the squared curvature over the lap [1/m].
  double SquaredCurvature() const;

  /// A place on the curve.
  struct Place {
    double s = 0.0;        // arc length from point 0 [m], below length()
    double lateral = 0.0;  // of the point asked for, positive to the left [m]
    double distance = 0.0;
  };
  /// The place nearest to `point`; the first one on a tie.
  Place Nearest(const Eigen::Vector2d& point) const;
  /// The point `lateral` to the left of the curve at arc length `s` (any, it wraps) [m].
  Eigen::Vector2d At(double s, double lateral) const;

 private:
  double spacing_;
  Points points_;
  Points normals_;
  std::vector<double> curvature_;
};

/// Evens out a closed curve: minimum of sum |q - p|^2 + (l / h)^6 sum |third differences of q|^2,
/// with l `smoothing_length` and h the curve's spacing [Whittaker 1923, Eilers 2003], periodic.
Points Smoothed(const ClosedCurve& curve, double smoothing_length);

}  // namespace hairpin
