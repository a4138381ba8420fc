#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/simulator/track.hpp"

namespace hairpin {

/// Points in order, in map [m]. Where a function takes `closed`, the last is joined with the first.
using Polyline = std::vector<Eigen::Vector2d>;

/// All cones of a track: left, right, others.
std::vector<TrackCone> AllCones(const Track& track);

Polyline PositionsOf(const std::vector<TrackCone>& cones);

size_t NumSegments(const Polyline& line, bool closed);
/// End of segment i, which begins at line[i].
const Eigen::Vector2d& SegmentEnd(const Polyline& line, size_t segment);

double Length(const Polyline& line, bool closed);

/// A place on a polyline.
struct PolylinePoint {
  size_t segment = 0;
  double fraction = 0.0;  // along the segment, 0 to 1
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double distance = 0.0;  // from the point that was asked for
};
/// The place nearest to `point`; the first one on a tie. `line` has at least two points.
PolylinePoint Nearest(const Polyline& line, bool closed, const Eigen::Vector2d& point);

/// Fractions along the lines a-b and c-d at which they meet, not limited to 0..1. Empty where they
/// are parallel.
std::optional<Eigen::Vector2d> MeetingFractions(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                                const Eigen::Vector2d& c, const Eigen::Vector2d& d);

/// True if the segments a-b and c-d touch or cross.
bool SegmentsMeet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                  const Eigen::Vector2d& d);

/// Even-odd rule.
bool IsInside(const Polyline& polygon, const Eigen::Vector2d& point);

/// An open line goes on straight by `length` at both ends.
Polyline Prolonged(Polyline line, double length);

/// Points at most `spacing` apart, evenly along an open line, both ends included.
Polyline Resampled(const Polyline& line, double spacing);

/// Angle from the direction `before` to `after`, counter-clockwise, in (-pi, pi].
double TurnBetween(const Eigen::Vector2d& before, const Eigen::Vector2d& after);

/// Two points of the sides that face each other.
struct CrossSection {
  Eigen::Vector2d left;
  Eigen::Vector2d right;
  double station = 0.0;  // along the centre line [m]
  Eigen::Vector2d middle() const { return 0.5 * (left + right); }
  double width() const { return (left - right).norm(); }
};

/// The track cut across, `spacing` apart on each side, in driving order: a closed track from the
/// start line once round to it again, an open one from its first cones to its last. Both sides are
/// walked at once, and the one steps on that gives the shorter next cut.
std::vector<CrossSection> CrossSections(const Track& track, double spacing);

/// Middles of the cross sections, about half a metre apart; a closed track's begins on the start
/// line and its last point is its first.
Polyline CentreLine(const Track& track);

/// True if `point` is between the sides; an open track goes on straight for 10 m before its first
/// and past its last cones.
bool IsOnTrack(const Track& track, const Eigen::Vector2d& point);

}  // namespace hairpin
