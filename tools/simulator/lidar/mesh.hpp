#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace hairpin {

/// Triangles over shared vertices [m].
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
};

/// Adds a box of the given size, centred at the origin of `T_mesh_box`.
void AddBox(const Eigen::Isometry3d& T_mesh_box, const Eigen::Vector3d& size, TriangleMesh& mesh);
/// Adds a closed truncated cone of `sides` sides that stands on the xy plane of `T_mesh_frustum`.
/// Equal radii make a cylinder.
void AddFrustum(const Eigen::Isometry3d& T_mesh_frustum, double bottom_radius, double top_radius,
                double height, uint32_t sides, TriangleMesh& mesh);

/// Upright at `position`, turned by `yaw`.
Eigen::Isometry3d Upright(const Eigen::Vector3d& position, double yaw);

}  // namespace hairpin
