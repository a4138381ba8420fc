#include "daemons/local_mapper/local_mapper_node.hpp"

#include <string>

#include "common/channels.hpp"
#include "daemons/local_mapper/conversion.hpp"

namespace hairpin {

LocalMapperNode::LocalMapperNode(const LocalMapperParams& params, Bus& bus)
    : bus_(bus), mapper_(params) {
  bus.Subscribe(channels::kPipelineStatus, [this](const pipeline_status_t& m) { OnStatus(m); });
  bus.Subscribe(channels::kVelocity, [this](const velocity_t& m) { OnVelocity(m); });
  SubscribeCones(channels::kConesFusion, Pipeline::kFusion);
  SubscribeCones(channels::kConesLidar, Pipeline::kLidar);
  SubscribeCones(channels::kConesCamera, Pipeline::kCamera);
}

void LocalMapperNode::SubscribeCones(const Channel<cones_t>& channel, Pipeline pipeline) {
  bus_.Subscribe(channel, [this, channel, pipeline](const cones_t& message) {
    const ConvertedSet converted = ToObservationSet(pipeline, message);
    if (!converted.set) return bus_.Refuse(channel, std::string(converted.problem));
    const LocalMapper::Outcome outcome = mapper_.Observe(*converted.set);
    if (!outcome.refused.empty()) bus_.Refuse(channel, std::string(outcome.refused));
    if (outcome.map) bus_.Publish(channels::kLocalMap, ToMessage(*outcome.map));
  });
}

void LocalMapperNode::OnStatus(const pipeline_status_t& status) {
  if (status.utime < status_utime_) {
    return bus_.Refuse(channels::kPipelineStatus, "time goes back");
  }
  const auto mode = static_cast<MapMode>(status.map_mode);
  if (status.map_mode < pipeline_status_t::MODE_NONE ||
      status.map_mode > pipeline_status_t::MODE_FUSION) {
    return bus_.Refuse(channels::kPipelineStatus, "unknown map mode");
  }
  status_utime_ = status.utime;
  mapper_.SetMode(mode);
}

void LocalMapperNode::OnVelocity(const velocity_t& velocity) {
  if (!velocity.valid) return;  // a gap, which the next valid one closes
  const std::string_view refused = mapper_.AddVelocity(
      velocity.utime, {velocity.vx_mps, velocity.vy_mps, velocity.yaw_rate_radps});
  if (!refused.empty()) bus_.Refuse(channels::kVelocity, std::string(refused));
}

}  // namespace hairpin
