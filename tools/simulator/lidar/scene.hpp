#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/simulator/lidar/clutter.hpp"
#include "tools/simulator/lidar/material.hpp"
#include "tools/simulator/lidar/ray_scene.hpp"
#include "tools/simulator/lidar/terrain.hpp"

namespace hairpin {

struct WorldParams {
  TerrainParams terrain;
  ClutterParams clutter;
  Materials materials;
  double cone_reflectivity_spread = 0.0;  // sigma of a cone's own factor (dirt, fading)
};

/// What one ray of a beam meets.
struct Target {
  float range = std::numeric_limits<float>::infinity();  // [m]; infinite: nothing
  float echo = 0.0f;  // share of a white diffuse target's that faces the sensor; above 1: retro
  int cone = -1;      // index into the scene's cones, -1: none
};
using BeamTargets = std::array<Target, kRaysPerBeam>;
using BeamDirections = std::array<Eigen::Vector3f, kRaysPerBeam>;

/// The world that LiDARs look at, in map: ground, grass, cones with their stripes, clutter.
class LidarScene {
 public:
  LidarScene(const WorldParams& params, const Track& track, uint64_t seed);

  /// The cones of the track, in its order: left, right, others.
  const std::vector<TrackCone>& cones() const { return cones_; }
  /// Those that still stand, a subsequence of cones(); the others vanish.
  void SetStanding(const std::vector<TrackCone>& standing);
  BeamTargets Cast(const Eigen::Vector3f& origin, const BeamDirections& directions,
                   float max_range) const;
  const Terrain& terrain() const { return terrain_; }

 private:
  Target GroundTarget(const RayHit& hit, const Eigen::Vector3f& point,
                      const Eigen::Vector3f& direction) const;
  Target ConeTarget(const RayHit& hit, size_t cone, double height) const;
  Target ToTarget(const RayHit& hit, Material material) const;

  WorldParams params_;
  std::vector<TrackCone> cones_;
  Terrain terrain_;
  RayScene rays_;                   // meshes: the ground, the cones in their order, the things
  std::vector<double> cone_foot_;   // height of its ground
  std::vector<float> cone_factor_;  // of its reflectivity
  std::vector<bool> standing_;
  std::vector<Material> thing_material_;
};

}  // namespace hairpin
