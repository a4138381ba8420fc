#include "daemons/global_mapper/global_mapper_node.hpp"

#include <iostream>
#include <string>

#include "common/channels.hpp"
#include "daemons/global_mapper/conversion.hpp"
#include "daemons/global_mapper/race_line_sender.hpp"

namespace hairpin {
namespace {

constexpr size_t kMaxLocalCones = 1000;  // as many as LOCAL_MAP can hold
constexpr double kMinLap = 100.0;        // m, of the drive that orders the cones

}  // namespace

GlobalMapperNode::GlobalMapperNode(const GlobalMapperConfig& config, Bus& bus)
    : config_(config), bus_(bus), store_(config.store) {
  PlanRaceLine();
  Begin(config_.known_map.has_value());
  bus.Subscribe(channels::kVehicle, [this](const vehicle_t& m) {
    const bool other =
        m.mission != vehicle_t::MISSION_UNKNOWN && m.mission != vehicle_t::MISSION_TRACKDRIVE;
    const bool localise = config_.known_map && !other;
    if (localise != localising_) Begin(localise);
  });
  bus.Subscribe(channels::kVelocity, [this](const velocity_t& m) { OnVelocity(m); });
  bus.Subscribe(channels::kLocalMap, [this](const local_map_t& m) { OnLocalMap(m); });
}

void GlobalMapperNode::PlanRaceLine() {
  if (!config_.known_map) return;
  std::vector<MappedCone> cones;
  for (const GlobalCone& cone : config_.known_map->cones)
    cones.push_back({cone.position, MostProbable(cone.colour)});
  try {
    const Points lap = LapOf(config_.known_map->driven, kMinLap);
    race_line_ = hairpin::PlanRaceLine(cones, lap, config_.race_line);
  } catch (const std::exception& error) {
    // The car then drives on sight.
    std::cerr << "global_mapper: no race line: " << error.what() << '\n';
  }
}

void GlobalMapperNode::Begin(bool localise) {
  localising_ = localise;
  resumed_ = false;
  if (localise) {
    mapper_.emplace(config_.params, KnownMap{config_.known_map->cones, config_.known_map->start});
  } else {
    mapper_.emplace(config_.params);
  }
}

void GlobalMapperNode::OnVelocity(const velocity_t& velocity) {
  if (!velocity.valid) return;  // a gap, which the next valid one closes
  const Eigen::Matrix3d covariance =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(velocity.covariance);
  const std::string_view refused = mapper_->AddVelocity(
      velocity.utime, {velocity.vx_mps, velocity.vy_mps, velocity.yaw_rate_radps}, covariance);
  if (!refused.empty()) bus_.Refuse(channels::kVelocity, std::string(refused));
}

void GlobalMapperNode::OnLocalMap(const local_map_t& message) {
  const ConvertedMap converted = ToLocalMapInput(message, kMaxLocalCones);
  if (!converted.map) return bus_.Refuse(channels::kLocalMap, std::string(converted.problem));
  if (!resumed_) Resume(message.utime);
  const GlobalMapper::Outcome outcome = mapper_->AddLocalMap(*converted.map);
  if (!outcome.refused.empty())
    return bus_.Refuse(channels::kLocalMap, std::string(outcome.refused));
  store_.Keep(outcome, bus_.boot_id());
  if (const std::string problem = store_.TakeProblem(); !problem.empty())
    std::cerr << "global_mapper: " << problem << ": nothing more is kept of the map\n";
  PublishRaceLine(*outcome.estimate);
  bus_.Publish(channels::kGlobalMap, ToMessage(*outcome.estimate));
}

void GlobalMapperNode::Resume(int64_t utime) {
  const size_t records = store_.Resume(utime, *mapper_);
  if (records > 0)
    std::cerr << "global_mapper: goes on with the journal's " << records << " records\n";
  resumed_ = true;
}

void GlobalMapperNode::PublishRaceLine(const GlobalMapEstimate& estimate) {
  if (!race_line_ || estimate.phase != MapPhase::kLocalised) return;
  const auto message = RaceLineMessage(*race_line_, estimate.utime, estimate.T_map_base,
                                       estimate.pose_covariance, config_.race_line_ahead);
  if (message) bus_.Publish(channels::kRaceLine, *message);
}

}  // namespace hairpin
