#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "daemons/lidar_cone_detector/clustering.hpp"
#include "daemons/lidar_cone_detector/point_cloud.hpp"

namespace hairpin {

/// Ground removal eats the foot of a cone. This takes back, from the full cloud, the points within
/// a cylinder about each cluster's middle [paper III-B by its citation]. One pass over the cloud
/// against a grid in which the cylinders have been marked.
class FootReconstruction {
 public:
  /// Throws std::invalid_argument where a parameter is not positive.
  FootReconstruction(double radius, double half_extent);

  /// For each centre the points within the radius and within [min_height, max_height] above the
  /// ground; a point within two cylinders belongs to the nearer centre.
  const Clusters& Run(const PointCloud& cloud, const std::vector<float>& height,
                      std::span<const Eigen::Vector2f> centres, float min_height, float max_height);

 private:
  size_t CellOf(float x, float y) const;
  void Mark(std::span<const Eigen::Vector2f> centres);

  static constexpr size_t kPerCell = 3;  // centres that one cell can know
  float radius_;
  float half_extent_;
  float per_metre_;
  size_t width_;
  std::vector<uint8_t> count_;    // of centres near each cell
  std::vector<uint16_t> nearby_;  // kPerCell for each cell
  std::vector<size_t> marked_;
  struct Hit {
    uint32_t point;
    uint32_t centre;
  };
  std::vector<Hit> hits_;
  std::vector<uint32_t> cursor_;
  Clusters clusters_;
};

}  // namespace hairpin
