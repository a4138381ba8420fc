#pragma once

#include "common/cone.hpp"
#include "tools/simulator/lidar/material.hpp"
#include "tools/simulator/lidar/mesh.hpp"

namespace hairpin {

/// A cone by the rules of Formula Student: square base plate, truncated cone, stripes about it.
struct ConeShape {
  double base_width;  // of the plate [m]
  double plate_height;
  double height;  // of the whole cone
  double bottom_radius;
  double top_radius;
};

/// 228 x 228 x 325 mm, or 285 x 285 x 505 mm for large orange.
const ConeShape& ShapeOf(ConeColour colour);

/// The cone standing at `T_mesh_cone`.
TriangleMesh ConeMesh(ConeColour colour, const Eigen::Isometry3d& T_mesh_cone);

/// What the cone's skin is at `height` [m] above its foot: plastic or stripe. Blue bears a white
/// stripe, yellow a black one, small orange a white one, large orange two white ones. Cones of
/// unknown colour are yellow without a stripe.
Material ConeMaterialAt(ConeColour colour, double height);

}  // namespace hairpin
