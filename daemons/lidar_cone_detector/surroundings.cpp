#include "daemons/lidar_cone_detector/surroundings.hpp"

#include <limits>
#include <stdexcept>

namespace hairpin {
namespace {

// So far behind an axis something is behind the cone and not beside it [m].
constexpr float kBehind = 0.2f;

}  // namespace

Surroundings::Surroundings(const SurroundingsParams& params, double half_extent)
    : params_(params), about_(params.clearance, half_extent) {
  if (!(params.body_radius > 0.0 && params.body_radius < params.clearance))
    throw std::invalid_argument("Surroundings: body_radius must be in (0, clearance)");
  if (params.min_returns < 1)
    throw std::invalid_argument("Surroundings: min_returns must be at least 1");
}

const std::vector<bool>& Surroundings::StandFree(const PointCloud& cloud,
                                                 const std::vector<float>& heights,
                                                 std::span<const Standing> cones) {
  centres_.clear();
  float lowest = std::numeric_limits<float>::max();
  for (const Standing& cone : cones) {
    centres_.push_back(cone.position);
    lowest = std::min(lowest, cone.top - static_cast<float>(params_.same_height));
  }
  const Clusters& about =
      about_.Run(cloud, heights, centres_, lowest, std::numeric_limits<float>::max());
  free_.assign(cones.size(), true);
  for (size_t k = 0; k < cones.size(); ++k) {
    const Standing& cone = cones[k];
    const Eigen::Vector2f line_of_sight = (cone.position - cone.sensor).normalized();
    int beside = 0;
    for (const uint32_t i : about[k]) {
      const Eigen::Vector2f from_axis = Eigen::Vector2f(cloud.x[i], cloud.y[i]) - cone.position;
      beside += from_axis.norm() > static_cast<float>(params_.body_radius) &&
                from_axis.dot(line_of_sight) < kBehind &&
                heights[i] > cone.top - static_cast<float>(params_.same_height);
    }
    free_[k] = beside < params_.min_returns;
  }
  return free_;
}

}  // namespace hairpin
