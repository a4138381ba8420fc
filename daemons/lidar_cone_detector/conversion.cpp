#include "daemons/lidar_cone_detector/conversion.hpp"

#include <algorithm>

namespace hairpin {
namespace {

constexpr double kLongestRevolution = 0.25;  // s; 4 Hz is slower than any sensor here turns

cone_observation_t ToObservation(const DetectedCone& cone, const ColourDistribution& colour) {
  ConeObservation observation;
  observation.position = cone.position.cast<double>();
  observation.covariance = cone.covariance.cast<double>();
  observation.colour = colour;
  return ToMessage(observation);
}

}  // namespace

std::string_view ToRevolution(const lidar_scan_t& message, LidarRevolution& revolution) {
  if (message.utime <= 0) return "no time";
  const std::string_view problem = UnpackPoints(message, revolution.points);
  if (!problem.empty()) return problem;
  revolution.utime = message.utime;
  revolution.ring_elevation.assign(message.ring_elevation_rad.begin(),
                                   message.ring_elevation_rad.end());
  revolution.azimuth_step = static_cast<float>(message.azimuth_step_rad);
  if (!(revolution.azimuth_step > 0.0f)) return "an azimuth step that cannot be";
  float oldest = 0.0f;
  for (const LidarPoint& point : revolution.points) oldest = std::max(oldest, point.age);
  revolution.duration = static_cast<double>(oldest);
  if (revolution.duration > kLongestRevolution) return "a revolution that lasts too long";
  return {};
}

std::vector<ConeReturns> ReturnsOf(const PointCloud& cloud, const std::vector<float>& heights,
                                   const std::vector<DetectedCone>& cones) {
  std::vector<ConeReturns> all;
  all.reserve(cones.size());
  for (const DetectedCone& cone : cones) {
    ConeReturns& returns = all.emplace_back();
    returns.axis = cone.position;
    for (const uint32_t i : cone.points) {
      returns.x.push_back(cloud.x[i]);
      returns.y.push_back(cloud.y[i]);
      returns.z.push_back(heights[i]);
      returns.age.push_back(cloud.age[i]);
      returns.intensity.push_back(cloud.intensity[i]);
    }
  }
  return all;
}

cone_clusters_t ToClustersMessage(int64_t utime, const std::vector<DetectedCone>& cones,
                                  const std::vector<ConeReturns>& returns,
                                  const std::vector<ColourDistribution>& colours,
                                  const std::vector<LookedAt>& sectors, double max_range) {
  cone_clusters_t message{};
  message.utime = utime;
  for (const LookedAt& sector : sectors) {
    message.sectors.push_back(
        {sector.min_bearing, sector.max_bearing, static_cast<float>(max_range)});
  }
  message.num_sectors = static_cast<int32_t>(message.sectors.size());
  for (size_t i = 0; i < cones.size(); ++i) {
    cone_cluster_t& cluster = message.clusters.emplace_back();
    cluster.cone = ToObservation(cones[i], colours[i]);
    cluster.num_points = static_cast<int32_t>(returns[i].x.size());
    cluster.x_m = returns[i].x;
    cluster.y_m = returns[i].y;
    cluster.z_m = returns[i].z;
    cluster.age_s = returns[i].age;
    cluster.intensity = returns[i].intensity;
  }
  message.num_clusters = static_cast<int32_t>(message.clusters.size());
  return message;
}

cones_t ToConesMessage(const cone_clusters_t& clusters) {
  cones_t message{};
  message.utime = clusters.utime;
  message.num_sectors = clusters.num_sectors;
  message.sectors = clusters.sectors;
  message.num_cones = clusters.num_clusters;
  for (const cone_cluster_t& cluster : clusters.clusters) message.cones.push_back(cluster.cone);
  return message;
}

}  // namespace hairpin
