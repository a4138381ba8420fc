#include "tools/simulator/track_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hairpin {

namespace {

constexpr double kProlongation = 10.0;  // m, the farthest that cones of a side may stand apart

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A side from the start line once round to it again, or as it is where open.
Polyline LapOf(const std::vector<TrackCone>& side, const Eigen::Vector2d& gate_end, bool closed) {
  Polyline line = PositionsOf(side);
  if (closed) {
    line.insert(line.begin(), gate_end);
    line.push_back(gate_end);
  }
  return line;
}

}  // namespace

std::vector<TrackCone> AllCones(const Track& track) {
  std::vector<TrackCone> all;
  for (const auto* cones : {&track.left, &track.right, &track.others})
    all.insert(all.end(), cones->begin(), cones->end());
  return all;
}

Polyline PositionsOf(const std::vector<TrackCone>& cones) {
  Polyline line;
  line.reserve(cones.size());
  for (const TrackCone& cone : cones) line.push_back(cone.position);
  return line;
}

size_t NumSegments(const Polyline& line, bool closed) {
  if (line.size() < 2) return 0;
  return closed ? line.size() : line.size() - 1;
}

const Eigen::Vector2d& SegmentEnd(const Polyline& line, size_t segment) {
  return line[(segment + 1) % line.size()];
}

double Length(const Polyline& line, bool closed) {
  double length = 0.0;
  for (size_t i = 0; i < NumSegments(line, closed); ++i) {
    length += (SegmentEnd(line, i) - line[i]).norm();
  }
  return length;
}

PolylinePoint Nearest(const Polyline& line, bool closed, const Eigen::Vector2d& point) {
  PolylinePoint nearest;
  nearest.distance = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < NumSegments(line, closed); ++i) {
    const Eigen::Vector2d along = SegmentEnd(line, i) - line[i];
    const double squared = along.squaredNorm();
    const double fraction =
        squared > 0.0 ? std::clamp((point - line[i]).dot(along) / squared, 0.0, 1.0) : 0.0;
    const Eigen::Vector2d position = line[i] + fraction * along;
    const double distance = (point - position).norm();
    if (distance < nearest.distance) nearest = {i, fraction, position, distance};
  }
  return nearest;
}

std::optional<Eigen::Vector2d> MeetingFractions(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                                const Eigen::Vector2d& c,
                                                const Eigen::Vector2d& d) {
  const Eigen::Vector2d ab = b - a;
  const Eigen::Vector2d cd = d - c;
  const double determinant = Cross(ab, cd);
  if (determinant == 0.0) return std::nullopt;
  return Eigen::Vector2d(Cross(c - a, cd) / determinant, Cross(c - a, ab) / determinant);
}

bool SegmentsMeet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                  const Eigen::Vector2d& d) {
  const auto fractions = MeetingFractions(a, b, c, d);
  if (fractions) return fractions->minCoeff() >= 0.0 && fractions->maxCoeff() <= 1.0;
  if (Cross(b - a, c - a) != 0.0) return false;  // parallel, not on one line
  const double squared = (b - a).squaredNorm();
  const double at_c = (c - a).dot(b - a) / squared;
  const double at_d = (d - a).dot(b - a) / squared;
  return std::max(at_c, at_d) >= 0.0 && std::min(at_c, at_d) <= 1.0;
}

bool IsInside(const Polyline& polygon, const Eigen::Vector2d& point) {
  bool inside = false;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = SegmentEnd(polygon, i);
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

Polyline Prolonged(Polyline line, double length) {
  const Eigen::Vector2d before = (line[0] - line[1]).normalized() * length + line[0];
  const Eigen::Vector2d after =
      (line.back() - line[line.size() - 2]).normalized() * length + line.back();
  line.insert(line.begin(), before);
  line.push_back(after);
  return line;
}

Polyline Resampled(const Polyline& line, double spacing) {
  const double length = Length(line, false);
  const size_t steps = std::max<size_t>(1, static_cast<size_t>(std::ceil(length / spacing)));
  Polyline points{line.front()};
  size_t segment = 0;
  double passed = 0.0;  // length before the segment
  for (size_t i = 1; i < steps; ++i) {
    const double station = length * static_cast<double>(i) / static_cast<double>(steps);
    double here = (line[segment + 1] - line[segment]).norm();
    while (passed + here < station && segment + 2 < line.size()) {
      passed += here;
      ++segment;
      here = (line[segment + 1] - line[segment]).norm();
    }
    const double fraction = here > 0.0 ? (station - passed) / here : 0.0;
    points.push_back(line[segment] + fraction * (line[segment + 1] - line[segment]));
  }
  points.push_back(line.back());
  return points;
}

double TurnBetween(const Eigen::Vector2d& before, const Eigen::Vector2d& after) {
  return std::atan2(Cross(before, after), before.dot(after));
}

std::vector<CrossSection> CrossSections(const Track& track, double spacing) {
  const Polyline left = Resampled(LapOf(track.left, track.start_line.left, track.closed), spacing);
  const Polyline right =
      Resampled(LapOf(track.right, track.start_line.right, track.closed), spacing);
  std::vector<CrossSection> sections{{left[0], right[0], 0.0}};
  size_t l = 0;
  size_t r = 0;
  while (l + 1 < left.size() || r + 1 < right.size()) {
    const bool can_left = l + 1 < left.size();
    const bool can_right = r + 1 < right.size();
    const bool step_left = can_left && (!can_right || (left[l + 1] - right[r]).norm() <=
                                                          (left[l] - right[r + 1]).norm());
    step_left ? ++l : ++r;
    CrossSection next{left[l], right[r], 0.0};
    next.station = sections.back().station + (next.middle() - sections.back().middle()).norm();
    sections.push_back(next);
  }
  return sections;
}

Polyline CentreLine(const Track& track) {
  constexpr double kSpacing = 0.5;
  Polyline middles;
  for (const CrossSection& section : CrossSections(track, kSpacing)) {
    middles.push_back(section.middle());
  }
  return Resampled(middles, kSpacing);
}

bool IsOnTrack(const Track& track, const Eigen::Vector2d& point) {
  Polyline left = PositionsOf(track.left);
  Polyline right = PositionsOf(track.right);
  if (track.closed) return IsInside(left, point) != IsInside(right, point);
  left = Prolonged(std::move(left), kProlongation);
  right = Prolonged(std::move(right), kProlongation);
  left.insert(left.end(), right.rbegin(), right.rend());
  return IsInside(left, point);
}

}  // namespace hairpin
