#include "tools/simulator/track_draft.hpp"

#include <algorithm>
#include <array>

#include "tools/simulator/track_geometry.hpp"
#include "tools/simulator/track_ordering.hpp"

namespace hairpin {

namespace {

constexpr double kInLine = 0.3;        // m from a side's line to a cone that is part of it
constexpr double kFillsGap = 1.0;      // m, where the side has a gap
constexpr double kGap = 5.0;           // m, the farthest that the rules allow
constexpr double kGateExtent = 8.0;    // m across which the large orange cones of one gate stand
constexpr double kAheadOfStart = 2.5;  // m from the centre of gravity: a metre ahead of the nose

using Line = std::vector<LocatedCone>;

Polyline PositionsOf(const Line& side) {
  Polyline line;
  for (const LocatedCone& cone : side) line.push_back(cone.cone.position);
  return line;
}

std::vector<TrackCone> ConesOf(const Line& side) {
  std::vector<TrackCone> cones;
  for (const LocatedCone& cone : side) cones.push_back(cone.cone);
  return cones;
}

/// Where `cone` belongs in `side`: the index to insert it at, with its distance to the side's line.
std::optional<std::pair<size_t, double>> PlaceIn(const Line& side, bool closed,
                                                 const LocatedCone& cone) {
  const Polyline line = PositionsOf(side);
  if (NumSegments(line, closed) == 0) return std::nullopt;
  const PolylinePoint near = Nearest(line, closed, cone.cone.position);
  const double length = (SegmentEnd(line, near.segment) - line[near.segment]).norm();
  if (near.distance > (length > kGap ? kFillsGap : kInLine)) return std::nullopt;
  return std::pair(near.segment + 1, near.distance);
}

void DropUnmarked(Line& side) {
  std::erase_if(side, [](const LocatedCone& cone) { return !cone.marked; });
}

/// A side that passes the start against the car's heading is turned round.
void Orient(Line& side, const TrackDraft& draft) {
  const Polyline line = PositionsOf(side);
  const PolylinePoint near = Nearest(line, draft.closed, draft.start.position());
  const Eigen::Vector2d along = SegmentEnd(line, near.segment) - line[near.segment];
  if (along.dot(draft.start.rotation().col(0)) < 0.0) std::reverse(side.begin(), side.end());
}

/// Middle of the gate's large orange cones on the left and on the right.
std::optional<LocatedGate> GateOfOrangeCones(const TrackDraft& draft) {
  Line orange;
  for (const Line* list : {&draft.left, &draft.right, &draft.others}) {
    for (const LocatedCone& cone : *list) {
      if (cone.cone.colour == ConeColour::kOrangeLarge) orange.push_back(cone);
    }
  }
  if (orange.empty()) return std::nullopt;
  const auto distance = [&](const LocatedCone& cone) {
    return (cone.cone.position - draft.start.position()).norm();
  };
  const LocatedCone first = *std::min_element(
      orange.begin(), orange.end(),
      [&](const LocatedCone& a, const LocatedCone& b) { return distance(a) < distance(b); });
  const Polyline left = PositionsOf(draft.left);
  const Polyline right = PositionsOf(draft.right);
  std::array<Eigen::Vector2d, 2> sums{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  std::array<int, 2> counts{};
  for (const LocatedCone& cone : orange) {
    const Eigen::Vector2d& position = cone.cone.position;
    if ((position - first.cone.position).norm() > kGateExtent) continue;
    const bool is_right = Nearest(right, draft.closed, position).distance <
                          Nearest(left, draft.closed, position).distance;
    sums[is_right] += position;
    ++counts[is_right];
  }
  if (counts[0] == 0 || counts[1] == 0) return std::nullopt;
  return LocatedGate{sums[0] / counts[0], sums[1] / counts[1], first.line};
}

LocatedGate GateAhead(const TrackDraft& draft) {
  return {draft.start * Eigen::Vector2d(kAheadOfStart, 1.0),
          draft.start * Eigen::Vector2d(kAheadOfStart, -1.0), draft.start_line_number};
}

/// The place where the line through the gate's points crosses a side, nearest to the gate's middle.
Eigen::Vector2d EndOn(const Line& side, const char* name, const LocatedGate& gate,
                      const TrackDraft& draft) {
  Polyline line = PositionsOf(side);
  if (!draft.closed) line = Prolonged(std::move(line), kMaxConeGap);
  const Eigen::Vector2d middle = 0.5 * (gate.a + gate.b);
  std::optional<Eigen::Vector2d> end;
  for (size_t i = 0; i < NumSegments(line, draft.closed); ++i) {
    const auto fractions = MeetingFractions(line[i], SegmentEnd(line, i), gate.a, gate.b);
    if (!fractions || fractions->x() < 0.0 || fractions->x() > 1.0) continue;
    const Eigen::Vector2d crossing = line[i] + fractions->x() * (SegmentEnd(line, i) - line[i]);
    if (!end || (crossing - middle).norm() < (*end - middle).norm()) end = crossing;
  }
  if (!end) {
    RefuseTrack(draft.file, gate.line,
                std::string("the line across the track does not reach the ") + name + " side");
  }
  return *end;
}

GateLine Across(const LocatedGate& gate, const TrackDraft& draft) {
  return {EndOn(draft.left, "left", gate, draft), EndOn(draft.right, "right", gate, draft)};
}

/// Makes the first cone on or past `gate_end` the first.
void BeginAt(Line& side, const Eigen::Vector2d& gate_end) {
  constexpr double kOnTheLine = 1e-6;  // m
  const PolylinePoint near = Nearest(PositionsOf(side), true, gate_end);
  const bool on_cone = (side[near.segment].cone.position - gate_end).norm() < kOnTheLine;
  const size_t first = (near.segment + (on_cone ? 0 : 1)) % side.size();
  std::rotate(side.begin(), side.begin() + static_cast<std::ptrdiff_t>(first), side.end());
}

int LineOf(const TrackProblem& problem, const TrackDraft& draft) {
  const auto at = [&](const Line& cones) {
    return problem.index < cones.size() ? cones[problem.index].line : 1;
  };
  switch (problem.part) {
    case TrackPart::kTrack:
      return 1;
    case TrackPart::kStart:
      return draft.start_line_number;
    case TrackPart::kStartLine:
      return draft.start_gate ? draft.start_gate->line : draft.start_line_number;
    case TrackPart::kFinishLine:
      return draft.finish_gate ? draft.finish_gate->line : draft.start_line_number;
    case TrackPart::kLeft:
      return at(draft.left);
    case TrackPart::kRight:
      return at(draft.right);
    case TrackPart::kOthers:
      return at(draft.others);
  }
  return 1;
}

std::vector<LocatedCone> Ordered(const std::vector<LocatedCone>& cones) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(cones.size());
  for (const LocatedCone& cone : cones) points.push_back(cone.cone.position);
  std::vector<LocatedCone> ordered;
  for (const size_t i : OrderAlongClosedCurve(points)) ordered.push_back(cones[i]);
  return ordered;
}

}  // namespace

void RefuseTrack(const std::string& file, int line, const std::string& reason) {
  throw TrackError(file + ":" + std::to_string(line) + ": " + reason);
}

void RefuseIf(const std::optional<TrackProblem>& problem, const TrackDraft& draft) {
  if (problem) RefuseTrack(draft.file, LineOf(*problem, draft), problem->what);
}

void JoinSides(TrackDraft& draft) {
  Line beside;
  for (const LocatedCone& cone : draft.others) {
    const bool orange =
        cone.cone.colour == ConeColour::kOrange || cone.cone.colour == ConeColour::kOrangeLarge;
    const auto left = PlaceIn(draft.left, draft.closed, cone);
    const auto right = PlaceIn(draft.right, draft.closed, cone);
    if (!orange || (!left && !right)) {
      beside.push_back(cone);
      continue;
    }
    const bool in_left = left && (!right || left->second <= right->second);
    Line& side = in_left ? draft.left : draft.right;
    const size_t index = in_left ? left->first : right->first;
    side.insert(side.begin() + static_cast<std::ptrdiff_t>(index), cone);
  }
  draft.others = std::move(beside);
  DropUnmarked(draft.left);
  DropUnmarked(draft.right);
}

Track ShapeOf(const TrackDraft& draft) {
  Track track;
  track.name = draft.name;
  track.closed = draft.closed;
  track.start = draft.start;
  track.left = ConesOf(draft.left);
  track.right = ConesOf(draft.right);
  track.others = ConesOf(draft.others);
  track.clutter = draft.clutter;
  return track;
}

Track Arrange(TrackDraft draft) {
  RefuseIf(FindShapeProblem(ShapeOf(draft)), draft);
  Orient(draft.left, draft);
  Orient(draft.right, draft);
  if (!draft.start_gate) draft.start_gate = GateOfOrangeCones(draft);
  if (!draft.start_gate) draft.start_gate = GateAhead(draft);
  const GateLine start_line = Across(*draft.start_gate, draft);
  GateLine finish_line = start_line;
  if (draft.closed) {
    BeginAt(draft.left, start_line.left);
    BeginAt(draft.right, start_line.right);
  } else {
    finish_line = draft.finish_gate
                      ? Across(*draft.finish_gate, draft)
                      : GateLine{draft.left.back().cone.position, draft.right.back().cone.position};
  }
  Track track = ShapeOf(draft);
  track.start_line = start_line;
  track.finish_line = finish_line;
  RefuseIf(FindProblem(track), draft);
  return track;
}

Track ArrangeUnordered(TrackDraft draft) {
  if (std::max(draft.left.size(), draft.right.size()) > kMaxConesOfSide) {
    RefuseTrack(draft.file, 1,
                "more than " + std::to_string(kMaxConesOfSide) + " cones of a colour");
  }
  draft.left = Ordered(draft.left);
  draft.right = Ordered(draft.right);
  JoinSides(draft);
  return Arrange(std::move(draft));
}

}  // namespace hairpin
