#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace hairpin {

/// Groups of points, each group's points behind one another.
struct Clusters {
  std::vector<uint32_t> points;  // indices into the cloud, by cluster and then rising
  std::vector<uint32_t> begin;   // of each cluster in `points`, and the end of the last one

  size_t size() const { return begin.empty() ? 0 : begin.size() - 1; }
  std::span<const uint32_t> operator[](size_t cluster) const {
    return {points.data() + begin[cluster], begin[cluster + 1] - begin[cluster]};
  }
};

/// Euclidean clusters in the plane: the connected components of "nearer than `tolerance`", the same
/// as PCL's EuclideanClusterExtraction gives for z = 0. Points are sorted into square cells whose
/// diagonal is the tolerance, so that all of a cell belong together and only pairs of near cells
/// have to be compared; a pair that is already connected is not. Clusters are numbered by their
/// first point.
class Clustering {
 public:
  /// Points with |x| or |y| beyond `half_extent` are left out. Throws std::invalid_argument where a
  /// parameter is not positive or the grid would exceed 16 million cells.
  Clustering(double tolerance, double half_extent);

  /// `selected`: indices of the points to cluster, rising.
  const Clusters& Run(const std::vector<float>& x, const std::vector<float>& y,
                      std::span<const uint32_t> selected);

 private:
  struct Cell {
    int32_t column, row;
    uint32_t first;  // in sorted_
    uint32_t count;
    uint32_t parent;  // union-find
    float min_x, max_x, min_y, max_y;
  };

  void SortIntoCells(const std::vector<float>& x, const std::vector<float>& y,
                     std::span<const uint32_t> selected);
  void ConnectNeighbours();
  bool AreNear(const Cell& a, const Cell& b) const;
  uint32_t Root(uint32_t cell);
  void Collect();

  float tolerance_squared_;
  float per_metre_;
  float half_extent_;
  int32_t width_;
  std::vector<uint32_t> cell_at_;            // grid: number of the occupied cell + 1, 0 where none
  std::vector<Cell> cells_;                  // occupied ones, in the order of their first point
  std::vector<uint32_t> cell_of_, members_;  // of the points that take part, in their order
  struct Planar {
    float x, y;
  };
  std::vector<Planar> sorted_;  // positions by cell
  std::vector<uint32_t> label_, cursor_;
  Clusters clusters_;
};

}  // namespace hairpin
