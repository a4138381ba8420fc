#pragma once

#include <Eigen/Core>
#include <vector>

#include "daemons/boundary_estimator/middle_path.hpp"

namespace hairpin {

struct SideChainParams {
  double min_spacing = 0.0;     // m; nearer cones are one and the same mark, as at the start gate
  double max_spacing = 0.0;     // m; between consecutive cones of a side
  double max_turn = 0.0;        // rad; of the side at one cone
  double min_log_ratio = 0.0;   // log p_assigned - log p_max that a cone of the side may have
  double default_width = 0.0;   // m; of the track, until one was seen
};

/// Throws std::invalid_argument naming the parameter, the relation and the bound.
void Check(const SideChainParams& params);

enum class Side { kLeft, kRight };

/// Follows one side of the track, cone by cone, from the cone `from` towards `direction`: each time to the nearest cone ahead
/// that the colour admits and that is not `taken`. Returns the cones after `from`, by index; marks them as taken.
std::vector<int> FollowSide(const std::vector<Eigen::Vector2d>& positions, const std::vector<double>& log_ratios, int from,
                            Eigen::Vector2d direction, std::vector<bool>& taken, const SideChainParams& params);

/// Gates at the cones of a side, each with its inferred opposite `width` away, perpendicular to the side. `before` is the
/// position before the first cone: it gives the side's direction there.
std::vector<Gate> InferGates(const Eigen::Vector2d& before, const std::vector<Eigen::Vector2d>& cones, Side side, double width);

}  // namespace hairpin
