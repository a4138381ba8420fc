#pragma once

#include <cmath>
#include <numbers>

#include "tools/simulator/track.hpp"

namespace hairpin {

/// An oval of two straights and two half circles, driven counter-clockwise, with its start line at
/// the map's origin and the car waiting before it, heading along x. Boundary cones at most
/// `spacing` apart, large orange ones at the line.
struct OvalShape {
  double straight = 40.0;  // m, as all
  double radius = 12.0;    // of the middle line
  double width = 3.5;
  double spacing = 4.0;
  double start_before_line = 3.0;
};

inline double OvalLength(const OvalShape& shape = {}) {
  return 2.0 * shape.straight + 2.0 * std::numbers::pi * shape.radius;
}

/// T_map_base of a car on the middle line, `distance` [m] from the start line. The line lies
/// half way along the lower straight.
inline Pose2 OvalPose(double distance, const OvalShape& shape = {}) {
  const double arc = std::numbers::pi * shape.radius;
  const double half = 0.5 * shape.straight;
  double s = std::fmod(distance, OvalLength(shape));
  if (s < 0.0) s += OvalLength(shape);
  if (s < half) return {s, 0.0, 0.0};
  s -= half;
  if (s < arc) {
    const double angle = s / shape.radius;
    return {half + shape.radius * std::sin(angle), shape.radius * (1.0 - std::cos(angle)),
            WrapAngle(angle)};
  }
  s -= arc;
  if (s < shape.straight) return {half - s, 2.0 * shape.radius, std::numbers::pi};
  s -= shape.straight;
  if (s < arc) {
    const double angle = s / shape.radius;
    return {-half - shape.radius * std::sin(angle), shape.radius * (1.0 + std::cos(angle)),
            WrapAngle(std::numbers::pi + angle)};
  }
  return {s - arc - half, 0.0, 0.0};
}

inline Track OvalTrack(const OvalShape& shape = {}) {
  Track track;
  track.name = "oval";
  track.start = OvalPose(-shape.start_before_line, shape);
  const double half_width = 0.5 * shape.width;
  track.start_line = {{0.0, half_width}, {0.0, -half_width}};
  track.finish_line = track.start_line;
  // By the outer circumference, so that no gap of the right side is larger than the spacing.
  const double outer = OvalLength({shape.straight, shape.radius + half_width});
  const int count = static_cast<int>(std::ceil(outer / shape.spacing));
  for (int i = 0; i < count; ++i) {
    const Pose2 T_map_middle = OvalPose(OvalLength(shape) * (i + 0.5) / count, shape);
    track.left.push_back({T_map_middle * Eigen::Vector2d(0.0, half_width), ConeColour::kBlue});
    track.right.push_back({T_map_middle * Eigen::Vector2d(0.0, -half_width), ConeColour::kYellow});
  }
  for (const double x : {-0.3, 0.3}) {
    for (const double side : {1.0, -1.0}) {
      track.others.push_back({{x, side * (half_width + 0.3)}, ConeColour::kOrangeLarge});
    }
  }
  return track;
}

}  // namespace hairpin
