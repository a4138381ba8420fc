#include "tools/evaluation/polyline.hpp"

#include <algorithm>
#include <stdexcept>

namespace hairpin {
namespace {

// Positive where c lies to the left of the line from a to b.
double Side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

bool OnOneSide(double a, double b) { return (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0); }

bool BoxesOverlap(const Segment& a, const Segment& b) {
  const auto overlap = [&](int axis) {
    const auto [a_min, a_max] = std::minmax(a.from[axis], a.to[axis]);
    const auto [b_min, b_max] = std::minmax(b.from[axis], b.to[axis]);
    return a_min <= b_max && b_min <= a_max;
  };
  return overlap(0) && overlap(1);
}

}  // namespace

bool Intersect(const Segment& a, const Segment& b) {
  return BoxesOverlap(a, b) && !OnOneSide(Side(a.from, a.to, b.from), Side(a.from, a.to, b.to)) &&
         !OnOneSide(Side(b.from, b.to, a.from), Side(b.from, b.to, a.to));
}

double Length(const Polyline& line) {
  double length = 0.0;
  for (size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

Polyline Clipped(const Polyline& line, double length) {
  Polyline clipped;
  double done = 0.0;
  for (const Eigen::Vector2d& point : line) {
    if (clipped.empty()) {
      clipped.push_back(point);
      continue;
    }
    const Eigen::Vector2d step = point - clipped.back();
    if (done + step.norm() > length) {
      clipped.push_back(clipped.back() + (length - done) / step.norm() * step);
      break;
    }
    done += step.norm();
    clipped.push_back(point);
  }
  return clipped;
}

Eigen::Vector2d PointAt(const Polyline& line, double along) {
  if (line.empty()) throw std::invalid_argument("PointAt: the line is empty");
  return Clipped(line, along).back();
}

Projection Project(const Eigen::Vector2d& point, const Polyline& line) {
  if (line.empty()) throw std::invalid_argument("Project: the line is empty");
  Projection nearest{(point - line.front()).norm(), 0.0};
  double done = 0.0;
  for (size_t i = 1; i < line.size(); ++i) {
    const Eigen::Vector2d step = line[i] - line[i - 1];
    const double squared = step.squaredNorm();
    const double ratio =
        squared > 0.0 ? std::clamp((point - line[i - 1]).dot(step) / squared, 0.0, 1.0) : 0.0;
    const double distance = (point - line[i - 1] - ratio * step).norm();
    if (distance < nearest.distance) nearest = {distance, done + ratio * step.norm()};
    done += step.norm();
  }
  return nearest;
}

}  // namespace hairpin
