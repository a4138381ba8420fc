#include "daemons/mission_manager/mission_manager_node.hpp"

#include <algorithm>
#include <cmath>

#include "common/cone.hpp"
#include "common/daemon.hpp"

namespace hairpin {
namespace {

// What no car here can be: such a message is nonsense, not an extreme.
constexpr double kMaxSpeed = 60.0;    // m/s
constexpr double kMaxYawRate = 15.0;  // rad/s

template <class M>
NeededChannel Need(const Channel<M>& channel) {
  return {channel.name, channel.rate_hz, channel.deadline_s};
}

VehicleInput ToInput(const vehicle_t& message) {
  VehicleInput input;
  input.mission = message.mission;
  input.speed = message.speed_mps;
  input.as.utime = message.utime;
  input.as.master_switch_on = message.master_switch_on != 0;
  input.as.tractive_system_on = message.tractive_system_on != 0;
  input.as.shutdown_circuit_closed = message.shutdown_circuit_closed != 0;
  input.as.brakes_engaged = message.brakes_engaged != 0;
  input.as.brakes_ok = message.brakes_ok != 0;
  input.as.ebs_activated = message.ebs_activated != 0;
  input.as.res_go = message.res_go != 0;
  input.as.res_stop = message.res_stop != 0;
  return input;
}

as_state_t ToMessage(const MissionReport& report, const vehicle_t& cause) {
  as_state_t message{};
  message.utime = cause.utime;
  message.state = static_cast<int32_t>(report.state);
  message.mission = cause.mission;
  message.lap = report.laps;
  message.laps_to_drive = report.laps_to_drive;
  message.mission_finished = report.mission_finished;
  message.distance_m = report.distance;
  message.reason = report.reason;
  return message;
}

LapCounterParams LoadLaps(const Config& config) {
  LapCounterParams laps;
  laps.gate.range = config.Number("gate_range_m", {1.0, 50.0});
  laps.gate.min_mass = config.Number("gate_min_mass", {0.05, 10.0});
  laps.gate.min_cone_mass = config.Number("gate_min_cone_mass", {0.01, 1.0});
  laps.gate.min_width = config.Number("gate_min_width_m", {0.5, 20.0});
  laps.gate.max_width = config.Number("gate_max_width_m", {0.5, 30.0});
  laps.min_lap_length = config.Number("min_lap_length_m", {1.0, 1000.0});
  laps.staging_distance = config.Number("staging_distance_m", {0.0, 50.0});
  laps.start_within = config.Number("start_within_m", {0.1, 200.0});
  laps.gate_margin = config.Number("gate_margin_m", {0.0, 10.0});
  laps.gate_memory = config.Number("gate_memory_m", {0.1, 200.0});
  laps.blind_tolerance = config.Number("blind_tolerance_m", {0.1, 50.0});
  laps.blind_overrun = config.Number("blind_overrun_m", {0.0, 50.0});
  laps.localised_overrun = config.Number("localised_overrun_m", {0.0, 50.0});
  laps.max_heading_error = config.Number("max_heading_error_rad", {0.01, 1.57});
  return laps;
}

}  // namespace

MissionManagerParams LoadMissionManagerParams(const Config& config) {
  MissionManagerParams params;
  params.needed_channels = {Need(channels::kVelocity), Need(channels::kPipelineStatus),
                            Need(channels::kLocalMap), Need(channels::kTrack),
                            Need(channels::kDriveCommand)};
  params.build = BuildId();
  params.types_hash = TypesHash();
  params.rate.window = config.Number("ready_after_s", {0.1, 60.0});
  params.rate.min_share = config.Number("min_rate_share", {0.0, 1.0});
  params.go_delay = config.Number("go_delay_s", {0.0, 60.0});
  params.autocross_laps = config.Integer("autocross_laps", 1, 100);
  params.trackdrive_laps = config.Integer("trackdrive_laps", 1, 100);
  params.localisation_deadline = channels::kGlobalMap.deadline_s;
  params.standstill_speed = config.Number("standstill_speed_mps", {0.01, 1.0});
  params.standstill_time = config.Number("standstill_time_s", {0.0, 10.0});
  params.history = config.Number("history_s", {0.3, 10.0});
  params.laps = LoadLaps(config);
  config.Finish();
  return params;
}

MissionManagerNode::MissionManagerNode(const MissionManagerParams& params, Bus& bus)
    : bus_(bus), manager_(params) {
  bus.Subscribe(channels::kVehicle, [this](const vehicle_t& message) { OnVehicle(message); });
  bus.Subscribe(channels::kVelocity, [this](const velocity_t& message) { OnVelocity(message); });
  bus.Subscribe(channels::kLocalMap, [this](const local_map_t& message) { OnLocalMap(message); });
  bus.Subscribe(channels::kPipelineStatus,
                [this](const pipeline_status_t& message) { OnPipelineStatus(message); });
  bus.Subscribe(channels::kHeartbeat, [this](const heartbeat_t& message) {
    manager_.TakeBuild(message.daemon, message.build, message.types_hash);
  });
  bus.Subscribe(channels::kGlobalMap, [this](const global_map_t& message) {
    manager_.TakeLocalisation({message.utime,
                               Now(message.utime),
                               message.phase,
                               {message.x_m, message.y_m, message.yaw_rad}});
  });
  bus.Subscribe(channels::kTrack, [this](const track_t& message) {
    manager_.Heard(channels::kTrack.name, Now(message.utime));
  });
  bus.Subscribe(channels::kDriveCommand, [this](const drive_command_t& message) {
    manager_.Heard(channels::kDriveCommand.name, Now(message.utime));
  });
}

int64_t MissionManagerNode::Now(int64_t utime) const {
  return std::max(bus_.newest_utime(), utime);
}

void MissionManagerNode::OnVehicle(const vehicle_t& message) {
  const auto report = manager_.Update(ToInput(message), Now(message.utime));
  if (!report) return bus_.Refuse(channels::kVehicle, "time does not increase");
  bus_.Publish(channels::kAsState, ToMessage(*report, message));
}

void MissionManagerNode::OnVelocity(const velocity_t& message) {
  if (message.valid == 0) return;
  const double speed = std::hypot(message.vx_mps, message.vy_mps);
  if (speed > kMaxSpeed || std::abs(message.yaw_rate_radps) > kMaxYawRate) {
    return bus_.Refuse(channels::kVelocity, "out of range");
  }
  const Twist2 twist{message.vx_mps, message.vy_mps, message.yaw_rate_radps};
  if (!manager_.TakeVelocity(message.utime, twist)) {
    return bus_.Refuse(channels::kVelocity, "time does not increase");
  }
  manager_.Heard(channels::kVelocity.name, Now(message.utime));
}

void MissionManagerNode::OnLocalMap(const local_map_t& message) {
  std::vector<GateCone> cones;
  for (const local_cone_t& cone : message.cones) {
    const double large_orange =
        static_cast<double>(cone.probability[cone_observation_t::ORANGE_LARGE]);
    const double mass = std::clamp(large_orange, 0.0, 1.0) *
                        std::clamp(static_cast<double>(cone.existence), 0.0, 1.0);
    cones.push_back({{cone.x_m, cone.y_m}, mass});
  }
  const Pose2 T_local_base{message.x_m, message.y_m, message.yaw_rad};
  if (!manager_.TakeLocalMap(message.utime, T_local_base, std::move(cones))) {
    return bus_.Refuse(channels::kLocalMap, "its time is outside the pose history");
  }
  manager_.Heard(channels::kLocalMap.name, Now(message.utime));
}

void MissionManagerNode::OnPipelineStatus(const pipeline_status_t& message) {
  if (message.utime < status_utime_) {
    return bus_.Refuse(channels::kPipelineStatus, "older than the last one");
  }
  status_utime_ = message.utime;
  const bool blind = message.map_mode <= pipeline_status_t::MODE_NONE ||
                     message.map_mode > pipeline_status_t::MODE_FUSION;
  const bool stop = message.level >= pipeline_status_t::LEVEL_CONTROLLED_STOP;
  manager_.TakeSupervision({blind, stop, message.reason});
  manager_.Heard(channels::kPipelineStatus.name, Now(message.utime));
}

}  // namespace hairpin
