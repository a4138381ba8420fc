#include "tools/simulator/lidar/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/require.hpp"

namespace hairpin {
namespace {

constexpr int kWaves = 3;          // of each kind
constexpr double kMeshStep = 1.0;  // m; linear between, a few mm off the bumps
constexpr double kRasterStep = 0.25;

int Cells(double length, double step) { return static_cast<int>(std::ceil(length / step)); }

}  // namespace

Terrain::Terrain(const TerrainParams& params, const std::vector<TrackCone>& cones, uint64_t seed)
    : params_(params) {
  RequireWithin("max_slope", params.max_slope, 0.0, 0.2);
  RequireWithin("slope_length", params.slope_length_m, 20.0, 1000.0);
  RequireWithin("bump_height", params.bump_height_m, 0.0, 0.2);
  RequireWithin("bump_length", params.bump_length_m, 4.0, 100.0);
  RequireWithin("run_off", params.run_off_m, 0.0, 50.0);
  RequireWithin("margin", params.margin_m, 1.0, 200.0);
  RequireWithin("grass_height", params.grass_height_m, 0.0, 0.5);
  if (cones.empty()) throw std::invalid_argument("terrain: a track without cones");
  Eigen::Vector2d low = cones.front().position;
  Eigen::Vector2d high = low;
  for (const TrackCone& cone : cones) {
    low = low.cwiseMin(cone.position);
    high = high.cwiseMax(cone.position);
  }
  corner_ = low.array() - params.margin_m;
  extent_ = (high - low).array() + 2.0 * params.margin_m;
  RandomStream random(seed, "terrain");
  AddWaves(params.max_slope * params.slope_length_m / (2.0 * std::numbers::pi * kWaves),
           params.slope_length_m, random);
  AddWaves(params.bump_height_m / kWaves, params.bump_length_m, random);
  BuildMesh();
  Pave(cones);
}

void Terrain::AddWaves(double amplitude, double length, RandomStream& random) {
  for (int i = 0; i < kWaves; ++i) {
    const double direction = random.Uniform(0.0, 2.0 * std::numbers::pi);
    const double number = 2.0 * std::numbers::pi / (length * random.Uniform(1.0, 2.0));
    waves_.push_back({number * Eigen::Vector2d(std::cos(direction), std::sin(direction)), amplitude,
                      random.Uniform(0.0, 2.0 * std::numbers::pi)});
  }
}

double Terrain::Height(double x, double y) const {
  double height = 0.0;
  for (const Wave& wave : waves_) {
    height +=
        wave.amplitude * std::sin(wave.wave_number.x() * x + wave.wave_number.y() * y + wave.phase);
  }
  return height;
}

Material Terrain::MaterialAt(double x, double y) const {
  const int column = static_cast<int>((x - corner_.x()) / kRasterStep);
  const int row = static_cast<int>((y - corner_.y()) / kRasterStep);
  if (column < 0 || column >= columns_ || row < 0 || row >= rows_) return Material::kGrass;
  return paved_[static_cast<size_t>(row) * static_cast<size_t>(columns_) +
                static_cast<size_t>(column)] != 0
             ? Material::kAsphalt
             : Material::kGrass;
}

void Terrain::BuildMesh() {
  const int columns = Cells(extent_.x(), kMeshStep) + 1;
  const int rows = Cells(extent_.y(), kMeshStep) + 1;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double x = corner_.x() + column * kMeshStep;
      const double y = corner_.y() + row * kMeshStep;
      mesh_.vertices.push_back(Eigen::Vector3d(x, y, Height(x, y)).cast<float>());
    }
  }
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const auto a = static_cast<uint32_t>(row * columns + column);
      const auto b = a + static_cast<uint32_t>(columns);
      mesh_.triangles.push_back({a, a + 1, b + 1});
      mesh_.triangles.push_back({a, b + 1, b});
    }
  }
}

void Terrain::Pave(const std::vector<TrackCone>& cones) {
  columns_ = Cells(extent_.x(), kRasterStep);
  rows_ = Cells(extent_.y(), kRasterStep);
  paved_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), 0);
  const int reach = Cells(params_.run_off_m, kRasterStep);
  for (const TrackCone& cone : cones) {
    const Eigen::Vector2d centre = (cone.position - corner_) / kRasterStep;
    const int column = static_cast<int>(centre.x());
    const int row = static_cast<int>(centre.y());
    for (int r = std::max(0, row - reach); r <= std::min(rows_ - 1, row + reach); ++r) {
      for (int c = std::max(0, column - reach); c <= std::min(columns_ - 1, column + reach); ++c) {
        const double distance = std::hypot(c + 0.5 - centre.x(), r + 0.5 - centre.y());
        if (distance * kRasterStep > params_.run_off_m) continue;
        paved_[static_cast<size_t>(r) * static_cast<size_t>(columns_) + static_cast<size_t>(c)] = 1;
      }
    }
  }
}

}  // namespace hairpin
