#pragma once

#include <Eigen/Core>
#include <vector>

namespace hairpin {

using Polyline = std::vector<Eigen::Vector2d>;

struct Segment {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
};

/// The nearest point of a polyline.
struct Projection {
  double distance = 0.0;  // m, from the polyline
  double along = 0.0;     // m, from its first point
};

/// True if the segments have a point in common, touching included.
bool Intersect(const Segment& a, const Segment& b);

double Length(const Polyline& line);

/// The first `length` metres; all of a shorter line.
Polyline Clipped(const Polyline& line, double length);

/// The point `along` metres from the start; the last one past the end. Throws std::invalid_argument
/// for an empty line.
Eigen::Vector2d PointAt(const Polyline& line, double along);

/// Throws std::invalid_argument for an empty line.
Projection Project(const Eigen::Vector2d& point, const Polyline& line);

}  // namespace hairpin
