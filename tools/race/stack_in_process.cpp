#include "daemons/boundary_estimator/boundary_estimator_node.hpp"
#include "daemons/can_gateway/can_gateway_node.hpp"
#include "daemons/local_mapper/local_mapper_node.hpp"
#include "daemons/mission_manager/mission_manager_node.hpp"
#include "daemons/path_tracker/path_tracker_node.hpp"
#include "daemons/velocity_estimator/velocity_estimator_node.hpp"
#include "daemons/watchdog/watchdog_node.hpp"
#include "tools/race/overrides.hpp"
#include "tools/race/stack.hpp"

namespace hairpin {
namespace {

std::map<std::string, NodeFactory> Factories(const Clock& clock, MemoryCanBus* can_bus) {
  return {
      {"velocity_estimator", Host([](Bus& bus, const Config& config) {
         return VelocityEstimatorNode(LoadVelocityEstimatorParams(config), bus);
       })},
      {"local_mapper", Host([](Bus& bus, const Config& config) {
         return LocalMapperNode(LoadLocalMapperParams(config), bus);
       })},
      {"boundary_estimator", Host([](Bus& bus, const Config& config) {
         return BoundaryEstimatorNode(LoadBoundaryEstimatorParams(config), bus);
       })},
      {"path_tracker", Host([](Bus& bus, const Config& config) {
         return PathTrackerNode(LoadPathTrackerParams(config), bus);
       })},
      {"mission_manager", Host([](Bus& bus, const Config& config) {
         return MissionManagerNode(LoadMissionManagerParams(config), bus);
       })},
      {"watchdog", Host([&clock](Bus& bus, const Config& config) {
         return WatchdogNode(LoadWatchdogParams(config), bus, clock);
       })},
      {"can_gateway", Host([&clock, can_bus](Bus& bus, const Config& config) {
         return CanGatewayNode(LoadCanGatewayConfig(config).gateway, bus, can_bus->Attach(clock),
                               clock);
       })},
  };
}

}  // namespace

const std::vector<std::string>& StackDaemons() {
  static const std::vector<std::string> names{"velocity_estimator", "watchdog",
                                              "local_mapper",       "boundary_estimator",
                                              "path_tracker",       "mission_manager"};
  return names;
}

std::vector<std::string> DaemonsOf(const StackOptions& options) {
  std::vector<std::string> names = StackDaemons();
  names.insert(names.end(), options.drivers.begin(), options.drivers.end());
  return names;
}

InProcessStack::InProcessStack(const StackOptions& options, Transport& transport)
    : options_(options), transport_(transport), factories_(Factories(clock_, options.can_bus)) {
  for (const std::string& name : DaemonsOf(options)) SetDaemon(name, true);
}

void InProcessStack::SetDaemon(const std::string& name, bool on) {
  if (on == members_.contains(name)) return;
  if (!on) {
    // The node goes first: it holds references to its bus.
    members_.at(name).node.reset();
    members_.erase(name);
    return;
  }
  try {
    const Config config =
        Config::Load(options_.config_dir, name, OverridesOf(name, options_.overrides));
    Member member;
    member.bus = std::make_unique<Bus>(transport_, name, ++starts_);
    member.heartbeat = std::make_unique<Heartbeat>(*member.bus);
    member.node = factories_.at(name)(*member.bus, config);
    members_.emplace(name, std::move(member));
  } catch (const ConfigError& error) {
    throw ConfigError(name + ": " + error.what());
  }
}

void InProcessStack::Tend(int64_t utime) {
  clock_.Set(utime);
  for (const std::string& name : DaemonsOf(options_)) {
    if (const auto member = members_.find(name); member != members_.end())
      member->second.node->Poll();
  }
}

}  // namespace hairpin
