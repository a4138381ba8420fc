#include "daemons/lidar_cone_detector/ground_plane.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace hairpin {
namespace {

constexpr int kIterations = 6;
constexpr double kFirstTolerance = 3.0;  // times the last one
constexpr double kMinWeight = 20.0;      // of cells that agree, to believe in a plane

struct Sums {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
};

Sums Accumulate(const PolarGrid& grid, const GroundPlane& plane, int bins, double tolerance) {
  Sums sums;
  for (int sector = 0; sector < grid.sectors(); ++sector) {
    for (int bin = 0; bin < bins; ++bin) {
      const size_t cell = grid.Cell(sector, bin);
      if (grid.lowest(cell) == PolarGrid::kEmpty) continue;
      const float x = grid.cosine(sector) * grid.lowest_range(cell);
      const float y = grid.sine(sector) * grid.lowest_range(cell);
      const double u = static_cast<double>(grid.lowest(cell) - plane.At(x, y)) / tolerance;
      if (std::abs(u) >= 1.0) continue;
      const double weight = (1.0 - u * u) * (1.0 - u * u);
      const Eigen::Vector3d row(1.0, static_cast<double>(x), static_cast<double>(y));
      sums.normal += weight * row * row.transpose();
      sums.right += weight * static_cast<double>(grid.lowest(cell)) * row;
    }
  }
  return sums;
}

}  // namespace

GroundPlane FitGroundPlane(const PolarGrid& grid, const GroundPlaneParams& params) {
  GroundPlane plane;
  const int bins = std::min(
      grid.bins(), static_cast<int>(params.max_range / static_cast<double>(grid.bin_length())));
  for (int i = 0; i < kIterations; ++i) {
    const double share = static_cast<double>(i) / (kIterations - 1);
    const double tolerance = params.tolerance * (kFirstTolerance + share * (1.0 - kFirstTolerance));
    const Sums sums = Accumulate(grid, plane, bins, tolerance);
    if (sums.normal(0, 0) < kMinWeight) break;
    // A faint pull to level keeps the solution unique where all cells lie in one direction.
    const Eigen::Matrix3d normal =
        sums.normal + Eigen::Vector3d(0.0, 1.0, 1.0).asDiagonal().toDenseMatrix();
    const Eigen::Vector3d solution = normal.ldlt().solve(sums.right);
    const double tilt = std::hypot(solution.y(), solution.z());
    const double scale = tilt > params.max_tilt ? params.max_tilt / tilt : 1.0;
    plane = {static_cast<float>(solution.x()), static_cast<float>(solution.y() * scale),
             static_cast<float>(solution.z() * scale)};
  }
  return plane;
}

}  // namespace hairpin
