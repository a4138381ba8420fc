#include "daemons/boundary_estimator/boundary_estimator_node.hpp"
#include "daemons/can_gateway/can_gateway_node.hpp"
#include "daemons/global_mapper/global_mapper_node.hpp"
#include "daemons/gnss_driver/gnss_driver_node.hpp"
#include "daemons/lidar_cone_detector/lidar_cone_detector_node.hpp"
#include "daemons/lidar_driver/lidar_driver_node.hpp"
#include "daemons/local_mapper/local_mapper_node.hpp"
#include "daemons/mission_manager/host.hpp"
#include "daemons/mission_manager/mission_manager_node.hpp"
#include "daemons/path_tracker/path_tracker_node.hpp"
#include "daemons/velocity_estimator/velocity_estimator_node.hpp"
#include "daemons/watchdog/watchdog_node.hpp"
#include "tools/race/overrides.hpp"
#include "tools/race/stack.hpp"

namespace hairpin {
namespace {

/// The driver without its sockets; listed in `drivers` while it lives.
class ListedDriver {
 public:
  ListedDriver(const Config& config, const std::string& instance, Bus& bus, Drivers& drivers)
      : node_(LoadLidarDriverParams(config, instance), instance, bus),
        drivers_(drivers),
        sensor_("lidar_" + instance) {
    drivers_.lidars[sensor_] = &node_;
  }
  ~ListedDriver() { drivers_.lidars.erase(sensor_); }
  ListedDriver(const ListedDriver&) = delete;
  ListedDriver& operator=(const ListedDriver&) = delete;

 private:
  LidarDriverNode node_;
  Drivers& drivers_;
  std::string sensor_;
};

/// The same for GNSS.
class ListedGnssDriver {
 public:
  ListedGnssDriver(const Config& config, Bus& bus, Drivers& drivers)
      : node_(LoadGnssDriverParams(config), bus), drivers_(drivers) {
    drivers_.gnss = &node_;
  }
  ~ListedGnssDriver() { drivers_.gnss = nullptr; }
  ListedGnssDriver(const ListedGnssDriver&) = delete;
  ListedGnssDriver& operator=(const ListedGnssDriver&) = delete;

 private:
  GnssDriverNode node_;
  Drivers& drivers_;
};

NodeFactory HostDriver(const std::string& instance, Drivers& drivers) {
  return Host([instance, &drivers](Bus& bus, const Config& config) {
    return ListedDriver(config, instance, bus, drivers);
  });
}

std::map<std::string, NodeFactory> Factories(const Clock& clock, Drivers& drivers,
                                             MemoryCanBus* can_bus) {
  return {
      {"lidar_driver_front", HostDriver("front", drivers)},
      {"lidar_driver_top", HostDriver("top", drivers)},
      {"gnss_driver", Host([&drivers](Bus& bus, const Config& config) {
         return ListedGnssDriver(config, bus, drivers);
       })},
      {"lidar_cone_detector", Host([](Bus& bus, const Config& config) {
         return LidarConeDetectorNode(LoadLidarConeDetectorParams(config), bus);
       })},
      {"velocity_estimator", Host([](Bus& bus, const Config& config) {
         return VelocityEstimatorNode(LoadVelocityEstimatorParams(config), bus);
       })},
      {"local_mapper", Host([](Bus& bus, const Config& config) {
         return LocalMapperNode(LoadLocalMapperParams(config), bus);
       })},
      {"global_mapper", Host([](Bus& bus, const Config& config) {
         return GlobalMapperNode(LoadGlobalMapperConfig(config), bus);
       })},
      {"boundary_estimator", Host([](Bus& bus, const Config& config) {
         return BoundaryEstimatorNode(LoadBoundaryEstimatorParams(config), bus);
       })},
      {"path_tracker", Host([](Bus& bus, const Config& config) {
         return PathTrackerNode(LoadPathTrackerParams(config), bus);
       })},
      {"mission_manager", Host([](Bus& bus, const Config& config) {
         const MissionManagerParams params = LoadMissionManagerParams(config);
         return MissionManagerNode(params, bus, ThisHost(params.startup.log_folder, bus.url()));
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

const std::vector<std::string>& StackDaemons(SensorLevel level) {
  static const std::vector<std::string> kCones{
      "velocity_estimator", "watchdog",     "local_mapper",   "global_mapper",
      "boundary_estimator", "path_tracker", "mission_manager"};
  static const std::vector<std::string> kRaw = [] {
    std::vector<std::string> names{"can_gateway", "gnss_driver", "lidar_driver_front",
                                   "lidar_driver_top", "lidar_cone_detector"};
    names.insert(names.end(), kCones.begin(), kCones.end());
    return names;
  }();
  return level == SensorLevel::kRaw ? kRaw : kCones;
}

DaemonProgram ProgramOf(const std::string& daemon) {
  const std::string driver = "lidar_driver";
  if (daemon.starts_with(driver + "_")) return {driver, daemon.substr(driver.size() + 1)};
  return {daemon, ""};
}

std::vector<std::string> DaemonsOf(const StackOptions& options) {
  std::vector<std::string> names = StackDaemons(options.level);
  names.insert(names.end(), options.drivers.begin(), options.drivers.end());
  return names;
}

InProcessStack::InProcessStack(const StackOptions& options, Transport& transport)
    : options_(options),
      transport_(transport),
      factories_(Factories(clock_, drivers_, options.can_bus)) {
  for (const std::string& name : DaemonsOf(options_)) SetDaemon(name, true);
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
    const std::string program = ProgramOf(name).program;
    const Config config =
        Config::Load(options_.config_dir, program, OverridesOf(program, options_.overrides));
    Member member;
    member.bus = std::make_unique<Bus>(transport_, name, ++starts_);
    member.heartbeat = std::make_unique<Heartbeat>(*member.bus, config.SiblingHash("car"));
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

void InProcessStack::SendPacket(const std::string& sensor, bool, std::span<const uint8_t> packet,
                                int64_t utime) {
  const auto driver = drivers_.lidars.find(sensor);
  if (driver != drivers_.lidars.end()) driver->second->OnPacket({packet, utime, std::nullopt});
}

void InProcessStack::SendGnss(std::span<const uint8_t> bytes) {
  if (drivers_.gnss != nullptr) drivers_.gnss->OnBytes(bytes);
}

}  // namespace hairpin
