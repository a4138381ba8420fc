#include "daemons/boundary_estimator/middle_path.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/require.hpp"

namespace hairpin {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Points each `spacing` along the polyline, and its end.
std::vector<PathPoint> Resample(const std::vector<PathPoint>& corners, double spacing) {
  std::vector<PathPoint> points{corners.front()};
  double next = spacing;  // distance from the corner at hand to the next point
  for (size_t i = 1; i < corners.size(); ++i) {
    const PathPoint& from = corners[i - 1];
    const Eigen::Vector2d step = corners[i].position - from.position;
    const double length = step.norm();
    for (; next < length; next += spacing) {
      const double ratio = next / length;
      points.push_back({from.position + ratio * step,
                        from.width + ratio * (corners[i].width - from.width), false});
    }
    next -= length;
  }
  const double left_over = (corners.back().position - points.back().position).norm();
  if (left_over < 0.5 * spacing && points.size() > 1) points.pop_back();
  if (left_over > 0.0) points.push_back(corners.back());
  return points;
}

// (1, 2, 1) / 4 on the inner points; both ends stay.
void Smooth(std::vector<PathPoint>& points, int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    Eigen::Vector2d before = points.front().position;
    for (size_t i = 1; i + 1 < points.size(); ++i) {
      const Eigen::Vector2d here = points[i].position;
      points[i].position = 0.25 * (before + 2.0 * here + points[i + 1].position);
      before = here;
    }
  }
}

// Heading change per metre over the last `window` of the path, positive to the left.
double EndCurvature(const std::vector<PathPoint>& points, double window) {
  const Eigen::Vector2d last = points.back().position - points[points.size() - 2].position;
  double turned = 0.0;
  double length = 0.0;
  Eigen::Vector2d after = last;
  for (size_t i = points.size() - 2; i > 0 && length < window; --i) {
    const Eigen::Vector2d before = points[i].position - points[i - 1].position;
    turned += std::atan2(Cross(before, after), before.dot(after));
    length += 0.5 * (before.norm() + after.norm());
    after = before;
  }
  return length > 0.0 ? turned / length : 0.0;
}

// A gate beside the car that does not stand square would send the path off sideways.
bool StandsAskew(const Eigen::Vector2d& from_car, const MiddlePathParams& params) {
  return from_car.norm() < params.join_length &&
         std::abs(std::atan2(from_car.y(), from_car.x())) > params.max_join_angle;
}

// Length past the last gate with cones on both sides.
double OneSidedEnd(const Stretch& stretch) {
  double length = 0.0;
  for (size_t i = stretch.size(); i-- > 1;) {
    const auto [left, right] = stretch.edges[i];
    if (left != CrossedEdge::kInferred && right != CrossedEdge::kInferred) break;
    length += (stretch.gates[i].middle() - stretch.gates[i - 1].middle()).norm();
  }
  return length;
}

void Extrapolate(std::vector<PathPoint>& points, double length, const MiddlePathParams& params) {
  if (points.size() < 2) return;
  const double limit = params.max_extrapolated_curvature;
  const double curvature = std::clamp(EndCurvature(points, params.curvature_window), -limit, limit);
  const Eigen::Vector2d last = points.back().position - points[points.size() - 2].position;
  double heading = std::atan2(last.y(), last.x());
  for (double done = 0.0; done < length; done += params.point_spacing) {
    const double step = std::min(params.point_spacing, length - done);
    const double bend = curvature * std::exp(-(done + 0.5 * step) / params.curvature_decay) * step;
    heading += 0.5 * bend;
    const Eigen::Vector2d position =
        points.back().position + step * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    heading += 0.5 * bend;
    points.push_back({position, points.back().width, true});
  }
}

}  // namespace

void Check(const MiddlePathParams& params) {
  constexpr Require require("MiddlePathParams");
  require(params.point_spacing > 0.0, "point_spacing must be > 0");
  require(params.join_length >= 0.0, "join_length must be >= 0");
  require(params.max_join_angle >= 0.0, "max_join_angle must be >= 0");
  require(params.smoothing_passes >= 0, "smoothing_passes must be >= 0");
  require(params.max_length > params.point_spacing, "max_length must be > point_spacing");
  require(params.extrapolation >= 0.0, "extrapolation must be >= 0");
  require(params.curvature_window > 0.0, "curvature_window must be > 0");
  require(params.curvature_decay > 0.0, "curvature_decay must be > 0");
  require(params.max_extrapolated_curvature >= 0.0, "max_extrapolated_curvature must be >= 0");
}

MiddlePath BuildMiddlePath(const Eigen::Vector2d& start, const Stretch& stretch,
                           const MiddlePathParams& params) {
  MiddlePath path;
  if (stretch.empty()) return path;
  const std::vector<Gate>& gates = stretch.gates;
  size_t first = 0;
  while (first + 1 < gates.size() && StandsAskew(gates[first].middle() - start, params)) ++first;
  const double first_width = first + 1 < gates.size() ? WidthBetween(gates[first], gates[first + 1])
                                                      : gates[first].width();
  std::vector<PathPoint> corners{{start, first_width, false},
                                 {gates[first].middle(), first_width, false}};
  for (size_t i = first + 1; i < gates.size(); ++i) {
    corners.push_back({gates[i].middle(), WidthBetween(gates[i - 1], gates[i]), false});
  }
  path.points = Resample(corners, params.point_spacing);
  Smooth(path.points, params.smoothing_passes);
  double length = 0.0;
  size_t kept = 1;
  for (; kept < path.points.size() && length < params.max_length; ++kept) {
    length += (path.points[kept].position - path.points[kept - 1].position).norm();
  }
  path.points.resize(kept);
  path.seen_length = length;
  const double guess = std::max(params.extrapolation - OneSidedEnd(stretch), 0.0);
  const double extrapolated = std::clamp(params.max_length - length, 0.0, guess);
  Extrapolate(path.points, extrapolated, params);
  path.length = length + (path.points.size() > kept ? extrapolated : 0.0);
  return path;
}

}  // namespace hairpin
