#include "tools/simulator/track_area.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr double kRunOff = 35.0;     // m: the 30 m in which a car has to stop, and its own length
constexpr double kSlabHeight = 1.0;  // m

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::vector<Eigen::Vector2d> Positions(const std::vector<TrackCone>& cones) {
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(cones.size());
  for (const TrackCone& cone : cones) positions.push_back(cone.position);
  return positions;
}

// Prolongs both boundaries past their ends, in the mean direction of the two.
void Prolong(std::vector<Eigen::Vector2d>& left, std::vector<Eigen::Vector2d>& right) {
  const auto last = [](const auto& side) {
    return (side.back() - side[side.size() - 2]).normalized();
  };
  const Eigen::Vector2d onward = kRunOff * (last(left) + last(right)).normalized();
  left.push_back(left.back() + onward);
  right.push_back(right.back() + onward);
}

// Is the point left of the edge, at its height? Half open in y, so that a corner counts once.
bool IsCrossed(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
               const Eigen::Vector2d& point) {
  if ((from.y() > point.y()) == (to.y() > point.y())) return false;
  const double x = from.x() + (point.y() - from.y()) / (to.y() - from.y()) * (to.x() - from.x());
  return point.x() < x;
}

}  // namespace

TrackArea::TrackArea(const Track& track) {
  std::vector<Eigen::Vector2d> left = Positions(track.left);
  std::vector<Eigen::Vector2d> right = Positions(track.right);
  const size_t least = track.closed ? 3 : 2;
  if (left.size() < least || right.size() < least) {
    throw std::invalid_argument("each boundary must have at least " + std::to_string(least) +
                                " cones, has " + std::to_string(left.size()) + " left and " +
                                std::to_string(right.size()) + " right");
  }
  if (track.closed) {
    AddPolygon(left);
    AddPolygon(right);
  } else {
    Prolong(left, right);
    std::reverse(left.begin(), left.end());
    std::reverse(right.begin(), right.end());
    Prolong(left, right);
    left.insert(left.end(), right.rbegin(), right.rend());
    AddPolygon(left);
  }
  BuildSlabs();
}

void TrackArea::AddPolygon(const std::vector<Eigen::Vector2d>& corners) {
  for (size_t i = 0; i < corners.size(); ++i)
    edges_.push_back({corners[i], corners[(i + 1) % corners.size()]});
}

void TrackArea::BuildSlabs() {
  double top = -std::numeric_limits<double>::infinity();
  bottom_ = std::numeric_limits<double>::infinity();
  for (const Edge& edge : edges_) {
    bottom_ = std::min(bottom_, edge.from.y());
    top = std::max(top, edge.from.y());
  }
  const auto slab_of = [this](double y) {
    return static_cast<size_t>((y - bottom_) / kSlabHeight);
  };
  slabs_.resize(slab_of(top) + 1);
  for (const Edge& edge : edges_) {
    const auto [low, high] = std::minmax(edge.from.y(), edge.to.y());
    for (size_t slab = slab_of(low); slab <= slab_of(high); ++slab) slabs_[slab].push_back(edge);
  }
}

bool TrackArea::Contains(const Eigen::Vector2d& point_map) const {
  const double slab = std::floor((point_map.y() - bottom_) / kSlabHeight);
  if (!(slab >= 0.0 && slab < static_cast<double>(slabs_.size()))) return false;
  // Even-odd over all edges at once: between two loops means inside exactly one of them.
  bool inside = false;
  for (const Edge& edge : slabs_[static_cast<size_t>(slab)])
    inside ^= IsCrossed(edge.from, edge.to, point_map);
  return inside;
}

GateCrossing CrossGate(const GateLine& line, const Eigen::Vector2d& before,
                       const Eigen::Vector2d& after) {
  const Eigen::Vector2d across = line.right - line.left;
  const Eigen::Vector2d way = after - before;
  // Positive ahead of the line: forward is a quarter turn counter-clockwise from left-to-right.
  const double ahead_before = Cross(across, before - line.left);
  const double ahead_after = Cross(across, after - line.left);
  if ((ahead_before < 0.0) == (ahead_after < 0.0)) return {};
  const double share = ahead_before / (ahead_before - ahead_after);
  const Eigen::Vector2d point = before + share * way;
  const double along = across.dot(point - line.left) / across.squaredNorm();
  if (along < 0.0 || along > 1.0) return {};
  return {ahead_before < 0.0 ? 1 : -1, share};
}

}  // namespace hairpin
