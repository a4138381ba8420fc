#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace hairpin {

/// A Delaunay triangulation as plain indices into the points that were given.
struct Triangulation {
  static constexpr int kOutside = -1;
  struct Triangle {
    std::array<int, 3> vertex;     // counter-clockwise
    std::array<int, 3> neighbour;  // across the edge opposite vertex[i]; kOutside past the hull
  };
  std::vector<Triangle> triangles;
};

/// Delaunay triangulation with exact predicates. The result depends on `points` and their order
/// alone; of points that coincide the first is used. Empty where all points lie on one line.
Triangulation Triangulate(const std::vector<Eigen::Vector2d>& points);

}  // namespace hairpin
