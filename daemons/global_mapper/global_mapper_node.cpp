#include "daemons/global_mapper/global_mapper_node.hpp"

#include <iostream>
#include <string>

#include "common/channels.hpp"
#include "daemons/global_mapper/conversion.hpp"

namespace hairpin {
namespace {

constexpr size_t kMaxLocalCones = 1000;  // as many as LOCAL_MAP can hold

}  // namespace

GlobalMapperNode::GlobalMapperNode(const GlobalMapperConfig& config, Bus& bus)
    : bus_(bus), mapper_(config.params), store_(config.store) {
  bus.Subscribe(channels::kVelocity, [this](const velocity_t& m) { OnVelocity(m); });
  bus.Subscribe(channels::kLocalMap, [this](const local_map_t& m) { OnLocalMap(m); });
}

void GlobalMapperNode::OnVelocity(const velocity_t& velocity) {
  if (!velocity.valid) return;  // a gap, which the next valid one closes
  const Eigen::Matrix3d covariance =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(velocity.covariance);
  const std::string_view refused = mapper_.AddVelocity(
      velocity.utime, {velocity.vx_mps, velocity.vy_mps, velocity.yaw_rate_radps}, covariance);
  if (!refused.empty()) bus_.Refuse(channels::kVelocity, std::string(refused));
}

void GlobalMapperNode::OnLocalMap(const local_map_t& message) {
  const ConvertedMap converted = ToLocalMapInput(message, kMaxLocalCones);
  if (!converted.map) return bus_.Refuse(channels::kLocalMap, std::string(converted.problem));
  if (!resumed_) {
    const size_t records = store_.Resume(message.utime, mapper_);
    if (records > 0)
      std::cerr << "global_mapper: goes on with the journal's " << records << " records\n";
    resumed_ = true;
  }
  const GlobalMapper::Outcome outcome = mapper_.AddLocalMap(*converted.map);
  if (!outcome.refused.empty())
    return bus_.Refuse(channels::kLocalMap, std::string(outcome.refused));
  store_.Keep(outcome, bus_.boot_id());
  if (const std::string problem = store_.TakeProblem(); !problem.empty())
    std::cerr << "global_mapper: " << problem << ": nothing more is kept of the map\n";
  bus_.Publish(channels::kGlobalMap, ToMessage(*outcome.estimate));
}

}  // namespace hairpin
