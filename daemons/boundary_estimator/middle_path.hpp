#pragma once

#include <Eigen/Core>
#include <vector>

#include "daemons/boundary_estimator/stretch.hpp"

namespace hairpin {

struct MiddlePathParams {
  double point_spacing = 0.0;  // m, along the path
  // Gates nearer to the car than join_length [m] and off its x axis by more than max_join_angle
  // [rad] are left out.
  double join_length = 0.0;
  double max_join_angle = 0.0;
  int smoothing_passes = 0;  // of a (1, 2, 1) / 4 filter over the points
  double max_length = 0.0;   // m
  double extrapolation =
      0.0;  // m, past the last gate with cones on both sides; cones of one side count into it
  double curvature_window = 0.0;            // m of path whose bend the extrapolation goes on with
  double curvature_decay = 0.0;             // m, along the extrapolation, to 1/e of that bend
  double max_extrapolated_curvature = 0.0;  // 1/m
};

/// Throws std::invalid_argument naming the parameter, the relation and the bound.
void Check(const MiddlePathParams& params);

struct PathPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double width = 0.0;         // m, of the track there
  bool extrapolated = false;  // past the last cone seen
};

struct MiddlePath {
  std::vector<PathPoint> points;  // the first at the car
  double length = 0.0;            // m
  double seen_length = 0.0;       // m, of the part that is not extrapolated
};

/// In base. From `start` through the middles of the stretch, evenly spaced and smoothed, then on
/// with its bend for the length of the extrapolation. An empty stretch: no points.
MiddlePath BuildMiddlePath(const Eigen::Vector2d& start, const Stretch& stretch,
                           const MiddlePathParams& params);

}  // namespace hairpin
