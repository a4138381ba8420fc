#include "daemons/global_mapper/start_gate.hpp"

namespace hairpin {
namespace {

constexpr double kMaxDistance = 30.0;  // m from the start
constexpr double kMinMass = 0.5;       // probability that a cone is a large orange one

Eigen::Vector2d Across(const MapGate& gate) { return (gate.left - gate.right).normalized(); }

}  // namespace

double MapGate::Past(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d across = Across(*this);
  return Eigen::Vector2d(across.y(), -across.x()).dot(point - right);
}

bool MapGate::Spans(const Eigen::Vector2d& point, double margin) const {
  const double along = Across(*this).dot(point - right);
  return along >= -margin && along <= (left - right).norm() + margin;
}

std::optional<MapGate> FindMapGate(const std::vector<GlobalCone>& cones) {
  MapGate gate;
  int num_left = 0;
  int num_right = 0;
  for (const GlobalCone& cone : cones) {
    if (ProbabilityOf(cone.colour, ConeColour::kOrangeLarge) < kMinMass) continue;
    if (cone.position.norm() > kMaxDistance) continue;
    (cone.position.y() > 0.0 ? gate.left : gate.right) += cone.position;
    ++(cone.position.y() > 0.0 ? num_left : num_right);
  }
  if (num_left == 0 || num_right == 0) return std::nullopt;
  gate.left /= num_left;
  gate.right /= num_right;
  return gate;
}

}  // namespace hairpin
