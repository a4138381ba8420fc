#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/simulator/track.hpp"

namespace hairpin {

/// The part of a track that something is wrong with.
enum class TrackPart { kTrack, kStart, kStartLine, kFinishLine, kLeft, kRight, kOthers };

struct TrackProblem {
  TrackPart part = TrackPart::kTrack;
  size_t index = 0;  // of the cone in its list
  std::string what;
};

/// Bounds beyond which a track is refused as impossible; wider than the rules, since real layouts
/// bend them.
inline constexpr size_t kMinConesOfSide = 3;
inline constexpr size_t kMaxConesOfSide = 2000;
inline constexpr double kMaxConeGap = 10.0;      // m between neighbours of a side
inline constexpr double kMinConeDistance = 0.1;  // m between any two cones
inline constexpr double kMinWidth = 2.0;         // m
inline constexpr double kMaxLineOffset = 0.5;    // m from an end of the start line to its side

/// What is impossible about cones and sides, whatever their order and start line: too few cones,
/// one twice, a gap, a wrong colour, sides that cross, a start outside the track. Empty if nothing.
std::optional<TrackProblem> FindShapeProblem(const Track& track);

/// The first thing that makes a track impossible to drive: the shape, the direction, the lines, the
/// width. Empty if none.
std::optional<TrackProblem> FindProblem(const Track& track);

/// Each violation of the competition's rules for an autocross or trackdrive layout, in words with
/// place and figure; empty for a legal track. Takes any track that FindProblem() accepts. An open
/// one is judged by its cones and width alone. Rules: Formula Student Germany; the distance of
/// neighbouring stretches and the gate's straight are ours.
std::vector<std::string> CheckRules(const Track& track);

}  // namespace hairpin
