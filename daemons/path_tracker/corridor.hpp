#pragma once

#include <Eigen/Core>
#include <vector>

namespace hairpin {

struct CorridorParams {
  double spacing = 0.0;     // of the points returned [m], > 0
  double margin = 0.0;      // from the line through a side's cones to the car's centre [m], > 0
  double max_offset = 0.0;  // from the middle path [m], >= 0; 0 leaves the path as it is
  double centring_length = 0.0;  // bends shorter than this are straightened [m], > 0
};

/// A stretch of track, in any one frame [m]: points of the middle path from the car outward, cones
/// of both sides in driving order. Without cones on a side the path is not moved towards it.
struct Corridor {
  std::vector<Eigen::Vector2d> middle;
  std::vector<Eigen::Vector2d> left;
  std::vector<Eigen::Vector2d> right;
};

/// The path of least bending between the sides, since a middle path has corners at the foot of each
/// cone that no car can follow. Minimises
///     sum |q_(i-1) - 2 q_i + q_(i+1)|^2 + (h / l)^4 sum d_i^2,   q_i = p_i + d_i n_i,
/// over the offsets d_i along the normals n_i, h apart, within the sides less the margin; l is the
/// centring length. It begins at the first middle point with the heading `start_yaw` [rad].
/// Box-constrained least squares by a primal-dual active set [Hintermueller, Ito, Kunisch 2003], of
/// bounded iterations. Throws std::invalid_argument for parameters out of their bounds. Fewer than
/// three points come back as they are.
std::vector<Eigen::Vector2d> LeastBending(const Corridor& corridor, double start_yaw,
                                          const CorridorParams& params);

}  // namespace hairpin
