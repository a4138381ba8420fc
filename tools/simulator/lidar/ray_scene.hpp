#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>

#include "tools/simulator/lidar/mesh.hpp"

namespace hairpin {

/// Rays of one beam: they start together and leave side by side.
inline constexpr size_t kRaysPerBeam = 8;

struct RayHit {
  float range = std::numeric_limits<float>::infinity();  // [m]; infinite: nothing met
  uint32_t mesh = 0;
  float cosine = 0.0f;  // of the angle between ray and surface normal, 0 to 1
};
using BeamHits = std::array<RayHit, kRaysPerBeam>;

/// Triangle meshes that rays are cast against, by Embree. Casting is const, and the same on every
/// machine: the instruction set is fixed to one without fused multiply-add.
class RayScene {
 public:
  /// Throws std::runtime_error where Embree cannot start.
  RayScene();
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// Adds a mesh and returns its number, counted from 0. Seen after the next Commit().
  uint32_t Add(const TriangleMesh& mesh);
  /// Takes a mesh out or puts it back. Seen after the next Commit().
  void Enable(uint32_t mesh, bool on);
  void Commit();

  /// What each ray meets first within `max_range` [m]. Directions are unit vectors.
  BeamHits Cast(const Eigen::Vector3f& origin,
                const std::array<Eigen::Vector3f, kRaysPerBeam>& directions, float max_range) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace hairpin
