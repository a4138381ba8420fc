#pragma once

#include "common/bus.hpp"
#include "common/config.hpp"
#include "daemons/mission_manager/mission_manager.hpp"

namespace hairpin {

/// Reads mission_manager.yaml; rates and deadlines come from the channel table. Throws ConfigError.
MissionManagerParams LoadMissionManagerParams(const Config& config);

/// VEHICLE, PIPELINE_STATUS, HEARTBEAT, LOCAL_MAP, VELOCITY -> AS_STATE, one for each VEHICLE, with
/// its utime. TRACK and DRIVE_COMMAND are heard too, only to know that they come.
class MissionManagerNode {
 public:
  MissionManagerNode(const MissionManagerParams& params, Bus& bus);
  MissionManagerNode(const MissionManagerNode&) = delete;
  MissionManagerNode& operator=(const MissionManagerNode&) = delete;

 private:
  void OnVehicle(const vehicle_t& message);
  void OnVelocity(const velocity_t& message);
  void OnLocalMap(const local_map_t& message);
  void OnPipelineStatus(const pipeline_status_t& message);
  int64_t Now(int64_t utime) const;

  Bus& bus_;
  MissionManager manager_;
  int64_t status_utime_ = 0;
};

}  // namespace hairpin
