#pragma once

#include <functional>
#include <string>

#include "common/bus.hpp"
#include "common/config.hpp"
#include "daemons/mission_manager/mission_console.hpp"
#include "daemons/mission_manager/mission_manager.hpp"

namespace hairpin {

/// Reads mission_manager.yaml; rates and deadlines come from the channel table. Throws ConfigError.
MissionManagerParams LoadMissionManagerParams(const Config& config);

/// Looks at the computer; asked once a second of data time while the car does not drive.
using HostProbe = std::function<HostFacts()>;

/// VEHICLE, PIPELINE_STATUS, HEARTBEAT, LOCAL_MAP, GLOBAL_MAP, VELOCITY -> AS_STATE, one for each
/// VEHICLE, with its utime. All other channels are heard too, only to know how they run.
class MissionManagerNode {
 public:
  MissionManagerNode(const MissionManagerParams& params, Bus& bus, HostProbe host);
  MissionManagerNode(const MissionManagerNode&) = delete;
  MissionManagerNode& operator=(const MissionManagerNode&) = delete;

 private:
  // Each returns false for a message that is of no use.
  bool Take(const vehicle_t& message);
  bool Take(const velocity_t& message);
  bool Take(const local_map_t& message);
  bool Take(const global_map_t& message);
  bool Take(const pipeline_status_t& message);
  template <class M>
  bool Take(const M&) {
    return true;
  }
  template <class M>
  bool Refuse(const Channel<M>& channel, const std::string& why) {
    bus_.Refuse(channel, why);
    return false;
  }
  int64_t Now(int64_t utime) const;

  Bus& bus_;
  HostProbe host_;
  MissionManager manager_;
  MissionConsole console_;
  AsState state_ = AsState::kOff;
  int64_t host_utime_ = 0;  // of the last look
  int64_t status_utime_ = 0;
};

}  // namespace hairpin
