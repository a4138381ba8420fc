#include "daemons/boundary_estimator/side_chain.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace hairpin {

void Check(const SideChainParams& params) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("SideChainParams: ") + what);
  };
  require(params.min_spacing > 0.0, "min_spacing must be > 0");
  require(params.max_spacing > params.min_spacing, "max_spacing must be > min_spacing");
  require(params.max_turn > 0.0 && params.max_turn < std::numbers::pi, "max_turn must be in (0, pi)");
  require(params.min_log_ratio <= 0.0, "min_log_ratio must be <= 0");
  require(params.default_width > 0.0, "default_width must be > 0");
}

std::vector<int> FollowSide(const std::vector<Eigen::Vector2d>& positions, const std::vector<double>& log_ratios, int from,
                            Eigen::Vector2d direction, std::vector<bool>& taken, const SideChainParams& params) {
  std::vector<int> chain;
  Eigen::Vector2d end = positions[static_cast<size_t>(from)];
  const double least_cosine = std::cos(params.max_turn);
  while (true) {
    int nearest = -1;
    double least = params.max_spacing;
    for (size_t i = 0; i < positions.size(); ++i) {
      const Eigen::Vector2d step = positions[i] - end;
      const double distance = step.norm();
      if (taken[i] || log_ratios[i] < params.min_log_ratio || distance > least || distance < params.min_spacing) continue;
      if (step.dot(direction) < least_cosine * distance) continue;
      nearest = static_cast<int>(i);
      least = distance;
    }
    if (nearest < 0) return chain;
    chain.push_back(nearest);
    taken[static_cast<size_t>(nearest)] = true;
    direction = (positions[static_cast<size_t>(nearest)] - end).normalized();
    end = positions[static_cast<size_t>(nearest)];
  }
}

std::vector<Gate> InferGates(const Eigen::Vector2d& before, const std::vector<Eigen::Vector2d>& cones, Side side, double width) {
  std::vector<Gate> gates;
  for (size_t i = 0; i < cones.size(); ++i) {
    const Eigen::Vector2d arriving = (cones[i] - (i == 0 ? before : cones[i - 1])).normalized();
    const Eigen::Vector2d leaving = i + 1 < cones.size() ? (cones[i + 1] - cones[i]).normalized() : arriving;
    const Eigen::Vector2d along = (arriving + leaving).normalized();
    const Eigen::Vector2d to_left = width * Eigen::Vector2d(-along.y(), along.x());
    gates.push_back(side == Side::kLeft ? Gate{cones[i], cones[i] - to_left} : Gate{cones[i] + to_left, cones[i]});
  }
  return gates;
}

}  // namespace hairpin
