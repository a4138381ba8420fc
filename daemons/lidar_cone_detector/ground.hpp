#pragma once

#include <vector>

#include "daemons/lidar_cone_detector/ground_lines.hpp"
#include "daemons/lidar_cone_detector/ground_plane.hpp"
#include "daemons/lidar_cone_detector/point_cloud.hpp"
#include "daemons/lidar_cone_detector/polar_grid.hpp"

namespace hairpin {

struct GroundParams {
  PolarGridParams grid;
  GroundPlaneParams plane;
  GroundLineParams lines;
};

/// Adaptive ground: polar cells, the lowest point of each, a plane through them all that takes out
/// roll and pitch of the body, and on what it leaves lines fitted piece by piece outward in every
/// sector [Himmelsbach 2010; paper III-B by its citation].
class Ground {
 public:
  /// Throws std::invalid_argument where a parameter cannot be.
  explicit Ground(const GroundParams& params);

  /// Estimates the ground, and the height of each point above it [m]. Points beyond the grid's
  /// range get the height above the ground at its edge.
  const std::vector<float>& Fit(const PointCloud& cloud);
  /// Height of the ground at (x, y), base [m].
  float HeightAt(float x, float y) const;
  const GroundPlane& plane() const { return plane_; }

 private:
  float Residual(float bearing, float range) const;

  GroundParams params_;
  PolarGrid grid_;
  GroundPlane plane_;
  GroundLines lines_;
  std::vector<float> height_;
};

}  // namespace hairpin
