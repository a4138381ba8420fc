#include "daemons/mission_manager/mission_manager.hpp"

#include <cmath>
#include <stdexcept>

#include "common/clock.hpp"
#include "hairpin/vehicle_t.hpp"

namespace hairpin {
namespace {

constexpr size_t kMaxDaemons = 64;  // a hostile sender of names must not grow memory

void Check(const MissionManagerParams& params) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("MissionManager: ") + what);
  };
  require(params.autocross_laps >= 1, "autocross_laps must be >= 1");
  require(params.standstill_speed > 0.0, "standstill_speed_mps must be > 0");
  require(params.standstill_time >= 0.0, "standstill_time_s must be >= 0");
}

}  // namespace

std::string MissionProblem(int32_t mission) {
  const char* name = nullptr;
  switch (mission) {
    case vehicle_t::MISSION_AUTOCROSS:
      return {};
    case vehicle_t::MISSION_ACCELERATION:
      name = "acceleration";
      break;
    case vehicle_t::MISSION_SKIDPAD:
      name = "skidpad";
      break;
    case vehicle_t::MISSION_TRACKDRIVE:
      name = "trackdrive";
      break;
    case vehicle_t::MISSION_BRAKE_TEST:
      name = "brake test";
      break;
    case vehicle_t::MISSION_INSPECTION:
      name = "inspection";
      break;
    case vehicle_t::MISSION_MANUAL:
      return "mission manual is the driver's";
    default:
      return "no mission is selected";
  }
  return std::string("mission ") + name + " cannot be driven yet";
}

MissionManager::MissionManager(const MissionManagerParams& params)
    : params_(params), machine_(params.go_delay), history_(params.history) {
  Check(params);
  const LapCounter check_params(params.laps);
  for (const NeededChannel& channel : params.needed_channels) {
    monitors_.emplace(channel.name,
                      RateMonitor(channel.name, channel.rate, channel.deadline, params.rate));
  }
}

void MissionManager::TakeBuild(const std::string& daemon, const std::string& build,
                               int64_t types_hash) {
  if (same_build_.size() >= kMaxDaemons && !same_build_.contains(daemon)) return;
  same_build_[daemon] = build == params_.build && types_hash == params_.types_hash;
}

bool MissionManager::TakeVelocity(int64_t utime, const Twist2& velocity) {
  if (!history_.Add(utime, velocity)) return false;
  if (drive_) {
    const Pose2 T_start_base = drive_->T_own_start.Inverse() * *history_.At(utime);
    drive_->laps.Move(T_start_base, history_.distance() - drive_->start_distance);
  }
  return true;
}

bool MissionManager::TakeLocalMap(int64_t utime, const Pose2& T_local_base,
                                  std::vector<GateCone> cones) {
  const std::optional<Pose2> T_own_base = history_.At(utime);
  if (!T_own_base) return false;
  if (!drive_) return true;
  const Pose2 T_start_base = drive_->T_own_start.Inverse() * *T_own_base;
  const Pose2 T_start_local = T_start_base * T_local_base.Inverse();
  for (GateCone& cone : cones) cone.position = T_start_local * cone.position;
  drive_->laps.Observe(cones, T_start_base, history_.distance() - drive_->start_distance);
  return true;
}

std::string MissionManager::SystemProblem(int64_t now) const {
  for (const auto& [daemon, same] : same_build_) {
    if (!same) return daemon + " is of another build";
  }
  for (const NeededChannel& channel : params_.needed_channels) {
    std::string problem = monitors_.at(channel.name).Problem(now);
    if (!problem.empty()) return problem;
  }
  if (!supervision_) return "the watchdog was never heard";
  if (supervision_->blind) return "no perception pipeline is live: " + supervision_->reason;
  if (supervision_->stop) return "the watchdog asks for a stop: " + supervision_->reason;
  return {};
}

bool MissionManager::Stands(const VehicleInput& vehicle) {
  if (std::abs(vehicle.speed) >= params_.standstill_speed || moved_utime_ == 0) {
    moved_utime_ = vehicle.as.utime;
  }
  return SecondsBetween(moved_utime_, vehicle.as.utime) >= params_.standstill_time;
}

bool MissionManager::MissionFinished() const {
  return drive_ && drive_->laps.laps() >= params_.autocross_laps;
}

std::optional<MissionReport> MissionManager::Update(const VehicleInput& vehicle, int64_t now) {
  if (vehicle.as.utime <= last_utime_) return std::nullopt;
  last_utime_ = vehicle.as.utime;
  AsInput input = vehicle.as;
  input.mission_problem = MissionProblem(vehicle.mission);
  input.system_problem = SystemProblem(now);
  input.mission_finished = MissionFinished();
  input.standstill = Stands(vehicle);
  const AsState before = machine_.state();
  const AsState state = machine_.Update(input);
  if (state == AsState::kDriving && before != AsState::kDriving) {
    const Pose2 T_own_start = history_.At(history_.newest_utime()).value_or(Pose2{});
    drive_.emplace(Drive{T_own_start, history_.distance(), LapCounter(params_.laps)});
  }
  MissionReport report;
  report.state = state;
  report.laps_to_drive = input.mission_problem.empty() ? params_.autocross_laps : 0;
  report.laps = drive_ ? drive_->laps.laps() : 0;
  report.mission_finished = MissionFinished();
  report.distance = drive_ ? history_.distance() - drive_->start_distance : 0.0;
  report.reason = Reason();
  return report;
}

std::string MissionManager::Reason() const {
  if (machine_.state() != AsState::kDriving || !drive_ || MissionFinished()) {
    return machine_.reason();
  }
  if (!drive_->laps.started()) return "driving to the start line";
  return "driving lap " + std::to_string(drive_->laps.laps() + 1) + " of " +
         std::to_string(params_.autocross_laps);
}

}  // namespace hairpin
