#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/simulator/track.hpp"
#include "tools/simulator/track_checks.hpp"

namespace hairpin {

/// A cone and the line of its file that tells of it.
struct LocatedCone {
  TrackCone cone;
  int line = 0;
  bool marked = true;  // false: the side passes here, but no cone stands
};

/// Two points of a line across the track, on either side of it.
struct LocatedGate {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  int line = 0;
};

/// A track as a file tells it, before its sides are brought in driving order from the start line
/// on.
struct TrackDraft {
  std::string file;
  std::string name;
  bool closed = true;
  Pose2 start;
  int start_line_number = 1;  // where the file tells the start pose
  std::optional<LocatedGate> start_gate;
  std::optional<LocatedGate> finish_gate;
  std::vector<LocatedCone> left;
  std::vector<LocatedCone> right;
  std::vector<LocatedCone> others;
  std::vector<Eigen::Vector2d> clutter;
};

[[noreturn]] void RefuseTrack(const std::string& file, int line, const std::string& reason);

/// Throws TrackError at the line of the cone or key that the problem names.
void RefuseIf(const std::optional<TrackProblem>& problem, const TrackDraft& draft);

/// Puts each orange cone of `draft.others` that marks a side into that side: those in line with it
/// (0.3 m), and those that fill a gap wider than the rules allow (within 1 m). Then drops the
/// unmarked places.
void JoinSides(TrackDraft& draft);

/// The track with the cones in the draft's order and without lines across: what FindShapeProblem()
/// takes.
Track ShapeOf(const TrackDraft& draft);

/// As Arrange(), for a lap whose sides come in any order.
Track ArrangeUnordered(TrackDraft draft);

/// Brings the sides into driving order from the start line on, and checks. The start line is, in
/// this order: the draft's gate, the middle of the large orange cones nearest to the start, a line
/// square to the car 2.5 m ahead. Lines across end on the sides. Throws TrackError.
Track Arrange(TrackDraft draft);

}  // namespace hairpin
