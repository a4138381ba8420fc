#pragma once

#include <Eigen/Core>
#include <vector>

namespace hairpin {

/// The order in which points lie along a closed curve: the shortest tour through them, which is the
/// curve's own order where points of a stretch are closer together than stretches are [Giesen 1999,
/// "Curve reconstruction, the traveling salesman problem and Menger's theorem on length"].
/// Nearest-neighbour tours from several starts, each improved by 2-opt and Or-opt; the best one,
/// beginning at point 0. Same points, same order.
std::vector<size_t> OrderAlongClosedCurve(const std::vector<Eigen::Vector2d>& points);

}  // namespace hairpin
