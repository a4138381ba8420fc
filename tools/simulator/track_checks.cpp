#include "tools/simulator/track_checks.hpp"

#include <algorithm>
#include <array>
#include <iomanip>
#include <sstream>

#include "tools/simulator/track_geometry.hpp"

namespace hairpin {

namespace {

using Problem = std::optional<TrackProblem>;

struct Side {
  TrackPart part;
  const char* name;
  const std::vector<TrackCone>& cones;
  ConeColour wrong_colour;
  const Eigen::Vector2d& start_line_end;
  const Eigen::Vector2d& finish_line_end;
};

std::array<Side, 2> SidesOf(const Track& track) {
  return {Side{TrackPart::kLeft, "left", track.left, ConeColour::kYellow, track.start_line.left,
               track.finish_line.left},
          Side{TrackPart::kRight, "right", track.right, ConeColour::kBlue, track.start_line.right,
               track.finish_line.right}};
}

std::string Metres(double length) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << length << " m";
  return text.str();
}

std::string At(const Eigen::Vector2d& position) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << " at (" << position.x() << ", " << position.y()
       << ")";
  return text.str();
}

Problem FindCountProblem(const Side& side) {
  const size_t count = side.cones.size();
  if (count == 0)
    return TrackProblem{TrackPart::kTrack, 0, std::string("no ") + side.name + " side"};
  const std::string has =
      std::string(side.name) + " side has " + std::to_string(count) + " cones, ";
  if (count < kMinConesOfSide) {
    return TrackProblem{side.part, 0, has + "fewer than " + std::to_string(kMinConesOfSide)};
  }
  if (count > kMaxConesOfSide) {
    return TrackProblem{side.part, 0, has + "more than " + std::to_string(kMaxConesOfSide)};
  }
  return std::nullopt;
}

Problem FindColourProblem(const Side& side) {
  for (size_t i = 0; i < side.cones.size(); ++i) {
    if (side.cones[i].colour != side.wrong_colour) continue;
    return TrackProblem{side.part, i,
                        std::string(NameOf(side.wrong_colour)) + " cone on the " + side.name +
                            " side; blue is left, yellow is right (a skidpad, whose lanes cross "
                            "and change colour, cannot be loaded)"};
  }
  return std::nullopt;
}

Problem FindDoubledCone(const Track& track) {
  struct Placed {
    TrackPart part;
    size_t index;
    Eigen::Vector2d position;
  };
  std::vector<Placed> before;
  const auto look_at = [&before](TrackPart part, const std::vector<TrackCone>& cones) -> Problem {
    for (size_t i = 0; i < cones.size(); ++i) {
      for (const Placed& other : before) {
        if ((cones[i].position - other.position).norm() >= kMinConeDistance) continue;
        return TrackProblem{part, i, "a cone stands here already" + At(other.position)};
      }
      before.push_back({part, i, cones[i].position});
    }
    return std::nullopt;
  };
  for (const Side& side : SidesOf(track)) {
    if (Problem problem = look_at(side.part, side.cones)) return problem;
  }
  return look_at(TrackPart::kOthers, track.others);
}

Problem FindGap(const Side& side, bool closed) {
  const Polyline line = PositionsOf(side.cones);
  for (size_t i = 0; i < NumSegments(line, closed); ++i) {
    const double gap = (SegmentEnd(line, i) - line[i]).norm();
    if (gap <= kMaxConeGap) continue;
    return TrackProblem{side.part, i,
                        std::string(side.name) + " side: the next cone," + At(SegmentEnd(line, i)) +
                            ", is " + Metres(gap) + " away, more than " + Metres(kMaxConeGap)};
  }
  return std::nullopt;
}

Problem FindSelfCrossing(const Side& side, bool closed) {
  const Polyline line = PositionsOf(side.cones);
  const size_t segments = NumSegments(line, closed);
  for (size_t i = 0; i < segments; ++i) {
    for (size_t j = i + 2; j < segments; ++j) {
      if (closed && i == 0 && j + 1 == segments) continue;  // neighbours
      if (!SegmentsMeet(line[i], SegmentEnd(line, i), line[j], SegmentEnd(line, j))) continue;
      return TrackProblem{side.part, j,
                          std::string(side.name) + " side crosses itself" + At(line[i])};
    }
  }
  return std::nullopt;
}

Problem FindCrossing(const Track& track) {
  const Polyline left = PositionsOf(track.left);
  const Polyline right = PositionsOf(track.right);
  for (size_t i = 0; i < NumSegments(left, track.closed); ++i) {
    for (size_t j = 0; j < NumSegments(right, track.closed); ++j) {
      if (!SegmentsMeet(left[i], SegmentEnd(left, i), right[j], SegmentEnd(right, j))) continue;
      return TrackProblem{TrackPart::kLeft, i, "left side crosses the right side" + At(right[j])};
    }
  }
  return std::nullopt;
}

/// The sides must pass the waiting car on their own hand, and the way it faces.
Problem FindWrongDirection(const Track& track) {
  const Eigen::Vector2d heading = track.start.rotation().col(0);
  for (const Side& side : SidesOf(track)) {
    const Polyline line = PositionsOf(side.cones);
    const PolylinePoint near = Nearest(line, track.closed, track.start.position());
    const bool is_left = (track.start.Inverse() * near.position).y() > 0.0;
    if (is_left != (side.part == TrackPart::kLeft)) {
      return TrackProblem{TrackPart::kStart, 0,
                          std::string("wrong direction: the ") + side.name +
                              " side is not on the " + side.name + " hand of the waiting car"};
    }
    if ((SegmentEnd(line, near.segment) - line[near.segment]).dot(heading) <= 0.0) {
      return TrackProblem{side.part, near.segment,
                          std::string(side.name) + " side is not in driving order"};
    }
  }
  return std::nullopt;
}

/// The lines lie across the track and end on the sides; a closed track's sides begin behind its
/// start line.
Problem FindLineProblem(const Track& track) {
  const auto crosses_track = [&track](const GateLine& line) {
    return IsOnTrack(track, 0.5 * (line.left + line.right));
  };
  if (!crosses_track(track.start_line)) {
    return TrackProblem{TrackPart::kStartLine, 0, "the start line does not lie across the track"};
  }
  if (!crosses_track(track.finish_line)) {
    return TrackProblem{TrackPart::kFinishLine, 0, "the finish line does not lie across the track"};
  }
  for (const Side& side : SidesOf(track)) {
    const Polyline line = PositionsOf(side.cones);
    const Polyline at_start =
        track.closed ? Polyline{line.back(), line.front()} : Prolonged(line, kMaxConeGap);
    if (Nearest(at_start, false, side.start_line_end).distance > kMaxLineOffset) {
      return TrackProblem{TrackPart::kStartLine, 0,
                          std::string("the start line does not end on the ") + side.name + " side" +
                              (track.closed ? " between its last and first cone" : "")};
    }
    if (track.closed) continue;
    if (Nearest(at_start, false, side.finish_line_end).distance > kMaxLineOffset) {
      return TrackProblem{
          TrackPart::kFinishLine, 0,
          std::string("the finish line does not end on the ") + side.name + " side"};
    }
  }
  return std::nullopt;
}

Problem FindNarrowing(const Track& track) {
  constexpr double kSpacing = 0.25;
  const std::vector<CrossSection> sections = CrossSections(track, kSpacing);
  const auto narrowest =
      std::min_element(sections.begin(), sections.end(),
                       [](const auto& a, const auto& b) { return a.width() < b.width(); });
  if (narrowest->width() >= kMinWidth) return std::nullopt;
  const PolylinePoint near = Nearest(PositionsOf(track.left), track.closed, narrowest->left);
  const size_t cone = (near.segment + (near.fraction > 0.5 ? 1 : 0)) % track.left.size();
  return TrackProblem{TrackPart::kLeft, cone,
                      "the track is " + Metres(narrowest->width()) + " wide" +
                          At(narrowest->middle()) + ", less than " + Metres(kMinWidth)};
}

}  // namespace

std::optional<TrackProblem> FindShapeProblem(const Track& track) {
  for (const Side& side : SidesOf(track)) {
    if (Problem problem = FindCountProblem(side)) return problem;
  }
  for (const Side& side : SidesOf(track)) {
    if (Problem problem = FindColourProblem(side)) return problem;
  }
  if (Problem problem = FindDoubledCone(track)) return problem;
  for (const Side& side : SidesOf(track)) {
    if (Problem problem = FindGap(side, track.closed)) return problem;
    if (Problem problem = FindSelfCrossing(side, track.closed)) return problem;
  }
  if (Problem problem = FindCrossing(track)) return problem;
  if (!IsOnTrack(track, track.start.position())) {
    return TrackProblem{TrackPart::kStart, 0,
                        "the start is outside the track" + At(track.start.position())};
  }
  return std::nullopt;
}

std::optional<TrackProblem> FindProblem(const Track& track) {
  if (Problem problem = FindShapeProblem(track)) return problem;
  if (Problem problem = FindWrongDirection(track)) return problem;
  if (Problem problem = FindLineProblem(track)) return problem;
  return FindNarrowing(track);
}

}  // namespace hairpin
