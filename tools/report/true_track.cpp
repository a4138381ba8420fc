#include "tools/report/true_track.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace hairpin {
namespace {

using Polyline = std::vector<Eigen::Vector2d>;

constexpr double kOpenEnd = 30.0;  // m: twice the longest path that is judged

Polyline Positions(const std::vector<truth_cone_t>& cones) {
  Polyline points;
  for (const truth_cone_t& cone : cones) points.emplace_back(cone.x_m, cone.y_m);
  return points;
}

ConeColour ToColour(int32_t colour) {
  const bool known = colour > 0 && colour < kNumConeColours;
  return known ? static_cast<ConeColour>(colour) : ConeColour::kUnknown;
}

/// Lengthens both boundaries by kOpenEnd behind their first points, along their common direction
/// there.
void ExtendFront(Polyline& left, Polyline& right) {
  if (left.size() < 2 || right.size() < 2) return;
  const Eigen::Vector2d back =
      (left[0] - left[1]).normalized() + (right[0] - right[1]).normalized();
  const Eigen::Vector2d step = kOpenEnd * back.normalized();
  left.insert(left.begin(), left[0] + step);
  right.insert(right.begin(), right[0] + step);
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Times the ring goes counter-clockwise about the point.
int WindingNumber(const Polyline& ring, const Eigen::Vector2d& point) {
  int winding = 0;
  for (size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d& a = ring[i];
    const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
    const bool upward = a.y() <= point.y() && b.y() > point.y();
    const bool downward = a.y() > point.y() && b.y() <= point.y();
    const double side = Cross(b - a, point - a);
    if (upward && side > 0.0) ++winding;
    if (downward && side < 0.0) --winding;
  }
  return winding;
}

}  // namespace

std::vector<TrueCone> TrueCones(const truth_track_t& track) {
  std::vector<TrueCone> cones;
  std::set<std::pair<double, double>> known;
  for (const auto* list : {&track.cones, &track.left, &track.right}) {
    for (const truth_cone_t& cone : *list) {
      const ConeColour colour = ToColour(cone.colour);
      if (colour == ConeColour::kUnknown || !known.emplace(cone.x_m, cone.y_m).second) continue;
      cones.push_back({{cone.x_m, cone.y_m}, colour});
    }
  }
  return cones;
}

std::vector<Eigen::Vector2d> Clutter(const truth_track_t& track) {
  Polyline clutter;
  for (const truth_cone_t& cone : track.cones) {
    if (ToColour(cone.colour) == ConeColour::kUnknown) clutter.emplace_back(cone.x_m, cone.y_m);
  }
  return clutter;
}

TrackBand::TrackBand(const truth_track_t& track) {
  Polyline left = Positions(track.left);
  Polyline right = Positions(track.right);
  if (track.closed) {
    std::reverse(right.begin(), right.end());
    rings_ = {std::move(left), std::move(right)};
    return;
  }
  ExtendFront(left, right);
  std::reverse(left.begin(), left.end());
  std::reverse(right.begin(), right.end());
  ExtendFront(left, right);
  std::reverse(left.begin(), left.end());
  left.insert(left.end(), right.begin(), right.end());
  rings_ = {std::move(left)};
}

bool TrackBand::Contains(const Eigen::Vector2d& point) const {
  int winding = 0;
  for (const Polyline& ring : rings_) winding += WindingNumber(ring, point);
  return winding != 0;
}

}  // namespace hairpin
