#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "daemons/lidar_cone_detector/foot_reconstruction.hpp"
#include "daemons/lidar_cone_detector/point_cloud.hpp"

namespace hairpin {

struct SurroundingsParams {
  double body_radius = 0.0;  // nearer returns are the cone's own [m]
  double clearance = 0.0;    // a cone has so much room to itself, from its axis [m]
  double same_height = 0.0;  // below a cone's top: lower things (kerbs, grass) are no matter [m]
  int min_returns = 0;       // of a neighbour
};

/// What a cone would have to itself, and what a piece of something larger shares with the rest of
/// it: columns of a row of tyres that show between their neighbours, the end of a barrier behind
/// something else. A piece's outline is that of what hides it, so that it can look like a cone.
class Surroundings {
 public:
  struct Standing {
    Eigen::Vector2f position;  // of the axis
    Eigen::Vector2f sensor;    // that saw it
    float top;                 // above the ground [m]
  };

  /// Throws std::invalid_argument where a parameter cannot be. `half_extent` [m]: of the square
  /// about base in which cones stand.
  Surroundings(const SurroundingsParams& params, double half_extent);

  /// Whether each stands alone: no returns as high as its top beside it or in front. What is behind
  /// it, seen from the sensor, is no matter, for that hides nothing of it; nor are the other ones'
  /// returns.
  const std::vector<bool>& StandFree(const PointCloud& cloud, const std::vector<float>& heights,
                                     std::span<const Standing> cones);

 private:
  SurroundingsParams params_;
  FootReconstruction about_;
  std::vector<Eigen::Vector2f> centres_;
  std::vector<bool> free_;
};

}  // namespace hairpin
