#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <sstream>

#include "tools/simulator/track_checks.hpp"
#include "tools/simulator/track_geometry.hpp"

namespace hairpin {

namespace {

constexpr double kRounding = 0.01;  // m, the tolerance of every bound below

constexpr double kMinWidthByRule = 3.0;
constexpr double kMaxSpacing = 5.0;
constexpr double kMaxCornerSpacing = 4.0;  // "less in corners", which the rules leave open
constexpr double kCornerBend = 25.0 / 180.0 * std::numbers::pi;  // rad at a cone that make a corner
constexpr double kMaxStraight = 80.0;
constexpr double kStraightBow = 0.5;  // m that a straight's line may leave its chord
constexpr double kHairpinTurn = 150.0 / 180.0 * std::numbers::pi;  // rad that make a hairpin
constexpr double kMinHairpinDiameter = 9.0;
constexpr double kConstantTurn = 0.5 * std::numbers::pi;  // rad over which a turn is measured
constexpr double kMaxTurnDiameter = 50.0;
constexpr double kMinLap = 200.0;
constexpr double kMaxLap = 500.0;
constexpr double kMinApart = 3.0;      // m between cones of different stretches, as wide as a track
constexpr double kSameStretch = 12.0;  // m along the track within which cones are of one stretch
constexpr double kGateReach = 3.0;     // m from an end of the line to its large orange cones
constexpr double kMinStartDistance = 4.0;  // m from the waiting car to the line: 6 by the rules
constexpr double kMaxStartDistance = 8.0;
constexpr double kStraightPastLine = 5.0;  // m
constexpr double kMaxGateBow = 0.3;  // m off a straight, from the waiting car to past the line

std::string Figure(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << value;
  return text.str();
}

std::string At(const Eigen::Vector2d& position) {
  return " at (" + Figure(position.x()) + ", " + Figure(position.y()) + ")";
}

using Violations = std::vector<std::string>;

void CheckWidth(const Track& track, Violations& violations) {
  constexpr double kSpacing = 0.25;
  const std::vector<CrossSection> sections = CrossSections(track, kSpacing);
  const auto narrowest =
      std::min_element(sections.begin(), sections.end(),
                       [](const auto& a, const auto& b) { return a.width() < b.width(); });
  if (narrowest->width() >= kMinWidthByRule - kRounding) return;
  violations.push_back("the track is " + Figure(narrowest->width()) + " m wide" +
                       At(narrowest->middle()) + ", less than 3 m");
}

/// How much a side bends at its point i [rad]; 0 at the ends of an open one.
double BendAt(const Polyline& line, bool closed, size_t i) {
  const size_t n = line.size();
  if (!closed && (i == 0 || i + 1 == n)) return 0.0;
  return TurnBetween(line[i] - line[(i + n - 1) % n], SegmentEnd(line, i) - line[i]);
}

/// Judges the spacing of a side, or of its corners: how many are too wide, and the widest.
void CheckSpacing(const std::string& side, const Polyline& line, bool closed, bool corners,
                  Violations& violations) {
  const double bound = corners ? kMaxCornerSpacing : kMaxSpacing;
  double widest = 0.0;
  size_t where = 0;
  int count = 0;
  for (size_t i = 0; i < NumSegments(line, closed); ++i) {
    const double spacing = (SegmentEnd(line, i) - line[i]).norm();
    const double bend = std::max(std::abs(BendAt(line, closed, i)),
                                 std::abs(BendAt(line, closed, (i + 1) % line.size())));
    if ((bend > kCornerBend) != corners || spacing <= bound + kRounding) continue;
    ++count;
    if (spacing > widest) where = i;
    widest = std::max(widest, spacing);
  }
  if (count == 0) return;
  violations.push_back(side + " side: " + std::to_string(count) +
                       (corners ? " gaps in corners" : " gaps") + " of more than " + Figure(bound) +
                       " m, the widest " + Figure(widest) + " m" + At(line[where]));
}

void CheckLap(double length, Violations& violations) {
  if (length < kMinLap - kRounding) {
    violations.push_back("the lap of " + Figure(length) + " m is shorter than 200 m");
  }
  if (length > kMaxLap + kRounding) {
    violations.push_back("the lap of " + Figure(length) + " m is longer than 500 m");
  }
}

double DistanceToLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                      const Eigen::Vector2d& point) {
  const Eigen::Vector2d along = (to - from).normalized();
  return std::abs(along.x() * (point - from).y() - along.y() * (point - from).x());
}

/// The longest chord that the centre line does not leave by more than a straight's bow.
void CheckStraights(const Polyline& centre, Violations& violations) {
  constexpr double kStep = 2.0;  // m
  const Polyline line = Resampled(centre, kStep);
  const size_t n = line.size() - 1;  // the last point is the first
  const auto bow = [&](size_t i, size_t j) {
    double largest = 0.0;
    for (size_t k = i + 1; k < j; ++k) {
      largest = std::max(largest, DistanceToLine(line[i], line[j % n], line[k % n]));
    }
    return largest;
  };
  double longest = 0.0;
  size_t where = 0;
  for (size_t i = 0; i < n; ++i) {
    size_t j = i + 1;
    while (j + 1 < i + n && bow(i, j + 1) <= kStraightBow) ++j;
    const double length = (line[j % n] - line[i]).norm();
    if (length <= longest) continue;
    longest = length;
    where = i;
  }
  if (longest <= kMaxStraight) return;
  violations.push_back("a straight of " + Figure(longest) + " m" + At(line[where]) +
                       ", longer than 80 m");
}

/// Diameter of the stretch of a side that begins in segment i and turns by `angle` with the sign of
/// `hand`, were it an arc: from the middle of its first segment to the middle of its last. Empty
/// where the side bends the other way before.
std::optional<double> DiameterOfTurn(const Polyline& line, size_t i, double angle, double hand) {
  const size_t n = line.size();
  double turned = 0.0;
  double length = 0.0;
  for (size_t k = i; k + 1 < i + n; ++k) {
    const Eigen::Vector2d before = SegmentEnd(line, k % n) - line[k % n];
    const Eigen::Vector2d after = SegmentEnd(line, (k + 1) % n) - line[(k + 1) % n];
    const double bend = hand * TurnBetween(before, after);
    if (bend < 0.0) return std::nullopt;
    turned += bend;
    length += 0.5 * (before.norm() + after.norm());
    if (turned >= angle) return 2.0 * length / turned;
  }
  return std::nullopt;
}

/// A turn is met as a run of segments from which a quarter circle begins; its tightest quarter
/// counts.
void CheckTurnDiameters(const Polyline& line, double hand, Violations& violations) {
  const size_t n = line.size();
  std::vector<std::optional<double>> diameters;
  for (size_t i = 0; i < n; ++i) diameters.push_back(DiameterOfTurn(line, i, kConstantTurn, hand));
  // From a break on, so that no run is cut by the end of the list.
  const auto broken = std::find(diameters.begin(), diameters.end(), std::nullopt);
  const auto first = static_cast<size_t>(broken - diameters.begin()) % n;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  double tightest = kNone;
  for (size_t k = 0; k <= n; ++k) {
    const auto& diameter = diameters[(first + k) % n];
    if (diameter && k < n) {
      tightest = std::min(tightest, *diameter);
      continue;
    }
    if (tightest != kNone && tightest > kMaxTurnDiameter + kRounding) {
      violations.push_back("a turn of " + Figure(tightest) + " m outside diameter before" +
                           At(line[(first + k) % n]) + ", more than 50 m");
    }
    tightest = kNone;
  }
}

/// Judges turns to one hand (1 left, -1 right) by the side outside of them.
void CheckTurns(const std::vector<TrackCone>& outside, double hand, Violations& violations) {
  const Polyline line = PositionsOf(outside);
  CheckTurnDiameters(line, hand, violations);
  for (size_t i = 0; i < line.size(); ++i) {
    const auto diameter = DiameterOfTurn(line, i, kHairpinTurn, hand);
    if (!diameter || *diameter >= kMinHairpinDiameter - kRounding) continue;
    violations.push_back("a hairpin of " + Figure(*diameter) + " m outside diameter" + At(line[i]) +
                         ", less than 9 m");
    return;  // its other segments say the same
  }
}

/// Cones that are near one another though far apart along the track.
void CheckStretches(const Track& track, const Polyline& centre, double length,
                    Violations& violations) {
  struct Placed {
    Eigen::Vector2d position;
    double station;
  };
  std::vector<double> stations{0.0};
  for (size_t i = 0; i + 1 < centre.size(); ++i) {
    stations.push_back(stations.back() + (centre[i + 1] - centre[i]).norm());
  }
  std::vector<Placed> cones;
  for (const auto* side : {&track.left, &track.right}) {
    for (const TrackCone& cone : *side) {
      cones.push_back({cone.position, stations[Nearest(centre, false, cone.position).segment]});
    }
  }
  for (size_t i = 0; i < cones.size(); ++i) {
    for (size_t j = i + 1; j < cones.size(); ++j) {
      const double distance = (cones[i].position - cones[j].position).norm();
      const double along = std::abs(cones[i].station - cones[j].station);
      if (std::min(along, length - along) < kSameStretch || distance >= kMinApart - kRounding)
        continue;
      violations.push_back("two stretches come within " + Figure(distance) + " m" +
                           At(cones[i].position) + ", less than 3 m");
      return;  // their other cones say the same
    }
  }
}

void CheckGate(const Track& track, Violations& violations) {
  const Eigen::Vector2d along = (track.start_line.left - track.start_line.right).normalized();
  std::array<int, 2> counts{};
  for (const auto* list : {&track.left, &track.right, &track.others}) {
    for (const TrackCone& cone : *list) {
      if (cone.colour != ConeColour::kOrangeLarge) continue;
      const Eigen::Vector2d from_left = cone.position - track.start_line.left;
      const Eigen::Vector2d from_right = cone.position - track.start_line.right;
      if (std::min(from_left.norm(), from_right.norm()) > kGateReach) continue;
      ++counts[from_left.dot(along) < from_right.dot(-along) ? 1 : 0];
    }
  }
  if (counts[0] == 2 && counts[1] == 2) return;
  violations.push_back(
      "no gate of four large orange cones at the start line: " + std::to_string(counts[0]) +
      " on the left, " + std::to_string(counts[1]) + " on the right");
}

/// The car waits some 6 m before the line, on a straight that reaches past it.
void CheckStart(const Track& track, const Polyline& centre, double length, Violations& violations) {
  const Pose2 T_base_map = track.start.Inverse();
  const Eigen::Vector2d middle = 0.5 * (track.start_line.left + track.start_line.right);
  const double ahead = (T_base_map * middle).x();
  if (ahead < kMinStartDistance || ahead > kMaxStartDistance) {
    violations.push_back("the car waits " + Figure(ahead) +
                         " m before the start line, not about 6 m");
  }
  double bow = 0.0;
  double station = 0.0;
  for (size_t i = 0; i + 1 < centre.size(); station += (centre[i + 1] - centre[i]).norm(), ++i) {
    if (station > kStraightPastLine && station < length - ahead) continue;
    bow = std::max(bow, std::abs((T_base_map * centre[i]).y()));
  }
  if (bow <= kMaxGateBow) return;
  violations.push_back("the start line is not on a straight: the centre line is " + Figure(bow) +
                       " m off the car's heading");
}

}  // namespace

std::vector<std::string> CheckRules(const Track& track) {
  Violations violations;
  CheckWidth(track, violations);
  for (const bool corners : {false, true}) {
    CheckSpacing("left", PositionsOf(track.left), track.closed, corners, violations);
    CheckSpacing("right", PositionsOf(track.right), track.closed, corners, violations);
  }
  if (!track.closed) return violations;
  const Polyline centre = CentreLine(track);
  const double length = Length(centre, false);
  CheckLap(length, violations);
  CheckStraights(centre, violations);
  CheckTurns(track.right, 1.0, violations);
  CheckTurns(track.left, -1.0, violations);
  CheckStretches(track, centre, length, violations);
  CheckGate(track, violations);
  CheckStart(track, centre, length, violations);
  return violations;
}

}  // namespace hairpin
