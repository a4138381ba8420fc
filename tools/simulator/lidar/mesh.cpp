#include "tools/simulator/lidar/mesh.hpp"

#include <cmath>
#include <numbers>

namespace hairpin {

void AddBox(const Eigen::Isometry3d& T_mesh_box, const Eigen::Vector3d& size, TriangleMesh& mesh) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                               (corner & 4) != 0 ? 0.5 : -0.5);
    mesh.vertices.push_back((T_mesh_box * sign.cwiseProduct(size)).cast<float>());
  }
  // Corners of the faces, in turn: -x +x -y +y -z +z.
  constexpr uint32_t kFaces[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1},
                                     {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
  for (const auto& face : kFaces) {
    mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
    mesh.triangles.push_back({first + face[0], first + face[2], first + face[3]});
  }
}

void AddFrustum(const Eigen::Isometry3d& T_mesh_frustum, double bottom_radius, double top_radius,
                double height, uint32_t sides, TriangleMesh& mesh) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  const auto add = [&](double radius, double angle, double z) {
    const Eigen::Vector3d point(radius * std::cos(angle), radius * std::sin(angle), z);
    mesh.vertices.push_back((T_mesh_frustum * point).cast<float>());
  };
  for (uint32_t side = 0; side < sides; ++side) {
    const double angle = 2.0 * std::numbers::pi * side / sides;
    add(bottom_radius, angle, 0.0);
    add(top_radius, angle, height);
  }
  add(0.0, 0.0, 0.0);
  add(0.0, 0.0, height);
  const uint32_t bottom = first + 2 * sides;
  const uint32_t top = bottom + 1;
  for (uint32_t side = 0; side < sides; ++side) {
    const uint32_t low = first + 2 * side;
    const uint32_t next_low = first + 2 * ((side + 1) % sides);
    mesh.triangles.push_back({low, next_low, next_low + 1});
    mesh.triangles.push_back({low, next_low + 1, low + 1});
    mesh.triangles.push_back({bottom, next_low, low});
    mesh.triangles.push_back({top, low + 1, next_low + 1});
  }
}

Eigen::Isometry3d Upright(const Eigen::Vector3d& position, double yaw) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(position).rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  return T;
}

}  // namespace hairpin
