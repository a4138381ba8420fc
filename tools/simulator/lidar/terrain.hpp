#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tools/simulator/lidar/material.hpp"
#include "tools/simulator/lidar/mesh.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/track.hpp"

namespace hairpin {

struct TerrainParams {
  double max_slope = 0.0;       // of the long waves together
  double slope_length_m = 0.0;  // their wavelength
  double bump_height_m = 0.0;   // amplitude of the short waves together
  double bump_length_m = 0.0;   // their wavelength
  double run_off_m = 0.0;       // asphalt reaches this far from the track's cones
  double margin_m = 0.0;        // of ground beyond them
  double grass_height_m = 0.0;
};

/// The ground: gentle slopes, bumps, asphalt about the track and grass beside. Heights in map.
class Terrain {
 public:
  /// Throws std::invalid_argument for values that cannot be.
  Terrain(const TerrainParams& params, const std::vector<TrackCone>& cones, uint64_t seed);

  double Height(double x, double y) const;
  /// Kerb stones lie on top; this is what is below.
  Material MaterialAt(double x, double y) const;
  const TriangleMesh& mesh() const { return mesh_; }
  const TerrainParams& params() const { return params_; }

 private:
  struct Wave {
    Eigen::Vector2d wave_number;
    double amplitude;
    double phase;
  };
  void AddWaves(double amplitude, double length, RandomStream& random);
  void BuildMesh();
  void Pave(const std::vector<TrackCone>& cones);

  TerrainParams params_;
  std::vector<Wave> waves_;
  Eigen::Vector2d corner_;  // of the rectangle with the least x and y
  Eigen::Vector2d extent_;
  int columns_ = 0;  // of the raster of materials
  int rows_ = 0;
  std::vector<uint8_t> paved_;
  TriangleMesh mesh_;
};

}  // namespace hairpin
