#include "daemons/mission_manager/start_line.hpp"

#include <cmath>
#include <string>

#include "common/require.hpp"

namespace hairpin {
namespace {

// Farther past the line than this at one step, the car has not crossed it: the line has jumped [m].
constexpr double kPassedBy = 3.0;

struct Side {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double mass = 0.0;
  void Add(const GateCone& cone) {
    sum += cone.mass * cone.position;
    mass += cone.mass;
  }
};

}  // namespace

double StartLine::Beside(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d off = point - centre;
  return std::abs(direction.x() * off.y() - direction.y() * off.x());
}

void Check(const GateParams& params) {
  constexpr Require require("Gate");
  require(params.range > 0.0, "gate_range_m must be > 0");
  require(params.min_mass > 0.0, "gate_min_mass must be > 0");
  require(params.min_cone_mass > 0.0, "gate_min_cone_mass must be > 0");
  require(params.min_width > 0.0, "gate_min_width_m must be > 0");
  require(params.max_width > params.min_width, "gate_max_width_m must be > gate_min_width_m");
}

std::optional<StartLine> FindGate(const std::vector<GateCone>& cones, const Pose2& T_frame_base,
                                  const GateParams& params) {
  std::vector<GateCone> near;
  for (const GateCone& cone : cones) {
    const bool in_range = (cone.position - T_frame_base.position()).norm() <= params.range;
    if (in_range && cone.mass >= params.min_cone_mass) near.push_back(cone);
  }
  size_t a = 0;
  size_t b = 0;
  double farthest = 0.0;
  for (size_t i = 0; i < near.size(); ++i) {
    for (size_t j = i + 1; j < near.size(); ++j) {
      const double distance = (near[i].position - near[j].position).norm();
      if (distance <= farthest) continue;
      farthest = distance;
      a = i;
      b = j;
    }
  }
  if (farthest < params.min_width) return std::nullopt;
  Side one;
  Side other;
  for (const GateCone& cone : near) {
    const bool nearer_to_a =
        (cone.position - near[a].position).norm() <= (cone.position - near[b].position).norm();
    (nearer_to_a ? one : other).Add(cone);
  }
  if (one.mass < params.min_mass || other.mass < params.min_mass) return std::nullopt;
  const Eigen::Vector2d across = other.sum / other.mass - one.sum / one.mass;
  const double width = across.norm();
  if (width < params.min_width || width > params.max_width) return std::nullopt;
  StartLine line;
  line.centre = 0.5 * (one.sum / one.mass + other.sum / other.mass);
  line.direction = Eigen::Vector2d(-across.y(), across.x()) / width;
  if (line.direction.dot(T_frame_base.rotation().col(0)) < 0.0) line.direction = -line.direction;
  line.half_width = 0.5 * width;
  return line;
}

bool CrossingWatch::Crosses(const StartLine& line, const Pose2& T_frame_base, double tolerance) {
  const double past = line.Past(T_frame_base.position());
  const bool aligned = T_frame_base.rotation().col(0).dot(line.direction) >= std::cos(max_angle_);
  const bool on_track = aligned && line.Beside(T_frame_base.position()) <= tolerance;
  if (past < 0.0) {
    approaching_ = on_track;
    return false;
  }
  const bool crosses = approaching_ && on_track && past <= kPassedBy;
  approaching_ = false;
  return crosses;
}

}  // namespace hairpin
