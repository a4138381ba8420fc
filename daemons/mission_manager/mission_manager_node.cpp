#include "daemons/mission_manager/mission_manager_node.hpp"

#include <algorithm>
#include <cmath>

#include "common/clock.hpp"
#include "common/daemon.hpp"

namespace hairpin {
namespace {

// What no car here can be: such a message is nonsense, not an extreme.
constexpr double kMaxSpeed = 60.0;    // m/s
constexpr double kMaxYawRate = 15.0;  // rad/s

constexpr double kHostPeriod = 1.0;  // s between looks at the computer

bool IsOneOf(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Stamped where something is measured, by a clock that is not this computer's.
bool Measures(const std::string& channel) {
  using namespace channels;
  return IsOneOf(channel, {kImu.name, kGroundSpeed.name, kMotors.name, kSteering.name, kGnss.name,
                           kVehicle.name, kLidarFront.name, kLidarTop.name});
}

// All but what this daemon sends itself, what comes only at times, what has no one rate, and what
// no daemon may hear.
bool IsChecked(const std::string& channel) {
  using namespace channels;
  return !IsOneOf(channel,
                  {kAsState.name, kRaceLine.name, kHeartbeat.name, kTruth.name, kTruthTrack.name});
}

std::vector<CheckedChannel> CheckedChannels() {
  std::vector<CheckedChannel> checked;
  ForEachChannel([&checked](const auto& channel) {
    if (!IsChecked(channel.name)) return;
    checked.push_back(
        {channel.name, channel.rate_hz, channel.deadline_s, false, Measures(channel.name)});
  });
  return checked;
}

VehicleReport ToInput(const vehicle_t& message) {
  VehicleReport input;
  input.as.mission = message.mission;
  input.speed = message.speed_mps;
  input.as.utime = message.utime;
  input.as.master_switch_on = message.master_switch_on != 0;
  input.as.tractive_system_on = message.tractive_system_on != 0;
  input.as.shutdown_circuit_closed = message.shutdown_circuit_closed != 0;
  input.as.brakes_engaged = message.brakes_engaged != 0;
  input.as.brakes_ok = message.brakes_ok != 0;
  const bool known =
      message.ebs_state >= vehicle_t::EBS_UNKNOWN && message.ebs_state <= vehicle_t::EBS_ACTIVATED;
  input.as.ebs = known ? static_cast<Ebs>(message.ebs_state) : Ebs::kUnknown;
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

StartupParams LoadStartup(const Config& config) {
  StartupParams startup;
  startup.channels = CheckedChannels();
  std::vector<std::string> names;
  for (const CheckedChannel& channel : startup.channels) names.push_back(channel.name);
  const std::vector<std::string> needed = config.Texts("needed_channels", names);
  for (CheckedChannel& channel : startup.channels) channel.needed = IsOneOf(channel.name, needed);
  startup.rate.window = config.Number("ready_after_s", {0.1, 60.0});
  startup.rate.min_share = config.Number("min_rate_share", {0.0, 1.0});
  startup.version = {BuildId(), TypesHash(), config.SiblingHash("car")};
  startup.log_folder = config.Text("log_folder");
  startup.min_free_disk = config.Number("min_free_disk_gb", {0.0, 1e4});
  startup.min_buffer = config.Number("min_receive_buffer_kb", {0.0, 1e5});
  return startup;
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

// What a straight course has of its own; the rest is as on laps.
LapCounterParams LoadAcceleration(const Config& config, LapCounterParams course) {
  course.course_length = config.Number("course_length_m", {1.0, 1000.0});
  course.min_lap_length = config.Number("min_length_m", {1.0, course.course_length});
  course.staging_distance = config.Number("staging_distance_m", {0.0, 50.0});
  course.start_within = config.Number("start_within_m", {0.1, 200.0});
  return course;
}

}  // namespace

MissionManagerParams LoadMissionManagerParams(const Config& config) {
  MissionManagerParams params;
  params.startup = LoadStartup(config);
  params.go_delay = config.Number("go_delay_s", {0.0, 60.0});
  params.autocross_laps = config.Integer("autocross_laps", 1, 100);
  params.trackdrive_laps = config.Integer("trackdrive_laps", 1, 100);
  params.localisation_deadline = channels::kGlobalMap.deadline_s;
  params.standstill_speed = config.Number("standstill_speed_mps", {0.01, 1.0});
  params.standstill_time = config.Number("standstill_time_s", {0.0, 10.0});
  params.history = config.Number("history_s", {0.3, 10.0});
  params.laps = LoadLaps(config);
  params.acceleration = LoadAcceleration(config.Section("acceleration"), params.laps);
  config.Finish();
  return params;
}

MissionManagerNode::MissionManagerNode(const MissionManagerParams& params, Bus& bus, HostProbe host)
    : bus_(bus), host_(std::move(host)), manager_(params), console_(bus.daemon()) {
  ForEachChannel([this](const auto& channel) {
    using Message = typename std::decay_t<decltype(channel)>::Message;
    if (!IsChecked(channel.name)) return;
    bus_.Subscribe(channel, [this, channel](const Message& message) {
      if (Take(message)) {
        manager_.startup().HeardChannel(channel.name, message.utime, Now(message.utime));
      }
    });
  });
  bus.Subscribe(channels::kHeartbeat, [this](const heartbeat_t& message) {
    manager_.startup().HeardDaemon(message.daemon,
                                   {message.build, message.types_hash, message.car_hash});
  });
}

int64_t MissionManagerNode::Now(int64_t utime) const {
  return std::max(bus_.newest_utime(), utime);
}

bool MissionManagerNode::Take(const vehicle_t& message) {
  const int64_t now = Now(message.utime);
  // Never while driving: a slow disk must not hold up the mission.
  if (state_ != AsState::kDriving && SecondsBetween(host_utime_, now) >= kHostPeriod) {
    host_utime_ = now;
    manager_.startup().TakeHost(host_());
  }
  const auto report = manager_.Update(ToInput(message), now);
  if (!report) return Refuse(channels::kVehicle, "time does not increase");
  state_ = report->state;
  if (console_.IsDue(*report, now)) console_.Tell(*report, manager_.SystemProblems(now));
  bus_.Publish(channels::kAsState, ToMessage(*report, message));
  return true;
}

bool MissionManagerNode::Take(const velocity_t& message) {
  if (message.valid == 0) return false;
  const double speed = std::hypot(message.vx_mps, message.vy_mps);
  if (speed > kMaxSpeed || std::abs(message.yaw_rate_radps) > kMaxYawRate) {
    return Refuse(channels::kVelocity, "out of range");
  }
  const Twist2 twist{message.vx_mps, message.vy_mps, message.yaw_rate_radps};
  if (!manager_.TakeVelocity(message.utime, twist)) {
    return Refuse(channels::kVelocity, "time does not increase");
  }
  return true;
}

bool MissionManagerNode::Take(const local_map_t& message) {
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
    return Refuse(channels::kLocalMap, "its time is outside the pose history");
  }
  return true;
}

bool MissionManagerNode::Take(const global_map_t& message) {
  manager_.TakeLocalisation({message.utime,
                             Now(message.utime),
                             message.phase,
                             {message.x_m, message.y_m, message.yaw_rad}});
  return true;
}

bool MissionManagerNode::Take(const pipeline_status_t& message) {
  if (message.utime < status_utime_) {
    return Refuse(channels::kPipelineStatus, "older than the last one");
  }
  status_utime_ = message.utime;
  const bool blind = message.map_mode <= pipeline_status_t::MODE_NONE ||
                     message.map_mode > pipeline_status_t::MODE_FUSION;
  const bool stop = message.level >= pipeline_status_t::LEVEL_CONTROLLED_STOP;
  manager_.TakeSupervision({blind, stop, message.reason});
  return true;
}

}  // namespace hairpin
