#include "daemons/local_mapper/conversion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hairpin {
namespace {

constexpr double kMaxSectorRange = 200.0;  // m; no sensor here reaches further
constexpr size_t kMaxSectors = 16;         // more sensors than any car has

bool IsSector(const view_sector_t& sector) {
  constexpr float kFullTurn = static_cast<float>(2.0 * std::numbers::pi);
  return sector.min_bearing_rad < sector.max_bearing_rad && sector.min_bearing_rad >= -kFullTurn &&
         sector.max_bearing_rad <= kFullTurn && sector.max_range_m >= 0.0f &&
         static_cast<double>(sector.max_range_m) <= kMaxSectorRange;
}

local_cone_t ToMessage(const LocalCone& cone) {
  local_cone_t message{};
  message.id = cone.id;
  message.last_seen_utime = cone.last_seen_utime;
  message.x_m = cone.position.x();
  message.y_m = cone.position.y();
  message.covariance_xx_m2 = cone.covariance(0, 0);
  message.covariance_xy_m2 = cone.covariance(0, 1);
  message.covariance_yy_m2 = cone.covariance(1, 1);
  for (size_t i = 0; i < cone.colour.size(); ++i) {
    message.probability[i] = static_cast<float>(cone.colour[i]);
  }
  message.existence = static_cast<float>(cone.existence);
  message.num_observations = cone.num_observations;
  return message;
}

}  // namespace

ConvertedSet ToObservationSet(Pipeline pipeline, const cones_t& message) {
  ObservationSet set{message.utime, pipeline, {}, {}};
  if (message.utime <= 0) return {std::nullopt, "no time"};
  if (message.sectors.size() > kMaxSectors) return {std::nullopt, "too many sectors"};
  for (const view_sector_t& sector : message.sectors) {
    if (!IsSector(sector)) return {std::nullopt, "a sector that cannot be"};
    set.sectors.push_back({sector.min_bearing_rad, sector.max_bearing_rad, sector.max_range_m});
  }
  for (const cone_observation_t& cone : message.cones) {
    const std::optional<ConeObservation> observation = ToConeObservation(cone);
    if (!observation)
      return {std::nullopt, "a cone with a covariance, colour or position that cannot be"};
    set.cones.push_back(*observation);
  }
  return {set, {}};
}

local_map_t ToMessage(const LocalMapEstimate& estimate) {
  local_map_t message{};
  message.utime = estimate.utime;
  message.epoch = estimate.epoch;
  message.map_mode = static_cast<int32_t>(estimate.mode);
  message.x_m = estimate.T_local_base.x;
  message.y_m = estimate.T_local_base.y;
  message.yaw_rad = estimate.T_local_base.yaw;
  message.num_cones = static_cast<int32_t>(estimate.cones.size());
  message.cones.reserve(estimate.cones.size());
  for (const LocalCone& cone : estimate.cones) message.cones.push_back(ToMessage(cone));
  return message;
}

}  // namespace hairpin
