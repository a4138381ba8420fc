#include "daemons/global_mapper/conversion.hpp"

#include <algorithm>
#include <cmath>

namespace hairpin {
namespace {

constexpr double kMaxLocalRange = 1e5;  // m: no local frame drifts farther

std::optional<LocalMapCone> ToCone(const local_cone_t& message, int64_t utime) {
  LocalMapCone cone;
  cone.id = message.id;
  cone.seen_now = message.last_seen_utime == utime;
  cone.last_seen_utime = message.last_seen_utime;
  cone.position = {message.x_m, message.y_m};
  cone.covariance << message.covariance_xx_m2, message.covariance_xy_m2, message.covariance_xy_m2,
      message.covariance_yy_m2;
  ColourDistribution weights;
  std::copy(std::begin(message.probability), std::end(message.probability), weights.begin());
  const auto colour = Normalised(weights);
  const auto existence = static_cast<double>(message.existence);
  const bool sound = IsCovariance(cone.covariance) && cone.position.norm() < kMaxLocalRange &&
                     colour && existence >= 0.0 && existence <= 1.0 &&
                     message.num_observations >= 0;
  if (!sound) return std::nullopt;
  cone.colour = *colour;
  cone.existence = existence;
  cone.num_observations = message.num_observations;
  return cone;
}

global_cone_t ToMessage(const GlobalCone& cone) {
  global_cone_t message{};
  message.id = cone.id;
  message.x_m = cone.position.x();
  message.y_m = cone.position.y();
  message.covariance_xx_m2 = cone.covariance(0, 0);
  message.covariance_xy_m2 = cone.covariance(0, 1);
  message.covariance_yy_m2 = cone.covariance(1, 1);
  for (size_t i = 0; i < cone.colour.size(); ++i)
    message.probability[i] = static_cast<float>(cone.colour[i]);
  message.num_observations = cone.num_observations;
  return message;
}

}  // namespace

ConvertedMap ToLocalMapInput(const local_map_t& message, size_t max_cones) {
  if (message.utime <= 0) return {std::nullopt, "no time"};
  if (message.cones.size() > max_cones) return {std::nullopt, "too many cones"};
  if (std::hypot(message.x_m, message.y_m) > kMaxLocalRange)
    return {std::nullopt, "a pose that cannot be"};
  LocalMapInput map{
      message.utime, message.epoch, {message.x_m, message.y_m, WrapAngle(message.yaw_rad)}, {}};
  for (const local_cone_t& cone : message.cones) {
    const auto converted = ToCone(cone, message.utime);
    if (!converted)
      return {std::nullopt,
              "a cone with a covariance, colour, existence or position that cannot be"};
    map.cones.push_back(*converted);
  }
  return {map, {}};
}

global_map_t ToMessage(const GlobalMapEstimate& estimate) {
  global_map_t message{};
  message.utime = estimate.utime;
  message.epoch = estimate.epoch;
  message.valid = estimate.valid;
  message.phase = static_cast<int32_t>(estimate.phase);
  message.x_m = estimate.T_map_base.x;
  message.y_m = estimate.T_map_base.y;
  message.yaw_rad = estimate.T_map_base.yaw;
  for (int i = 0; i < 9; ++i) message.pose_covariance[i] = estimate.pose_covariance(i / 3, i % 3);
  message.T_map_local[0] = estimate.T_map_local.x;
  message.T_map_local[1] = estimate.T_map_local.y;
  message.T_map_local[2] = estimate.T_map_local.yaw;
  message.laps = estimate.laps;
  message.keyframes = estimate.keyframes;
  for (const GlobalCone& cone : estimate.cones) {
    if (message.cones.size() < kMaxGlobalMapCones) message.cones.push_back(ToMessage(cone));
  }
  message.num_cones = static_cast<int32_t>(message.cones.size());
  return message;
}

}  // namespace hairpin
