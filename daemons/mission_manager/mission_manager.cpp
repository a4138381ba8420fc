#include "daemons/mission_manager/mission_manager.hpp"

#include <algorithm>
#include <cmath>

#include "common/clock.hpp"
#include "common/require.hpp"
#include "daemons/mission_manager/missions.hpp"
#include "hairpin/global_map_t.hpp"
#include "hairpin/vehicle_t.hpp"

namespace hairpin {
namespace {

void Check(const MissionManagerParams& params) {
  constexpr Require require("MissionManager");
  require(params.autocross_laps >= 1, "autocross_laps must be >= 1");
  require(params.trackdrive_laps >= 1, "trackdrive_laps must be >= 1");
  require(params.localisation_deadline > 0.0, "the deadline of GLOBAL_MAP must be > 0");
  require(params.standstill_speed > 0.0, "standstill_speed_mps must be > 0");
  require(params.standstill_time >= 0.0, "standstill_time_s must be >= 0");
}

}  // namespace

MissionManager::MissionManager(const MissionManagerParams& params)
    : params_(params),
      machine_(params.go_delay),
      history_(params.history),
      startup_(params.startup) {
  Check(params);
  for (const LapCounterParams& laps : {params.laps, params.acceleration}) LapCounter check(laps);
}

void MissionManager::TakeLocalisation(const LocalisationInput& localisation) {
  localisation_ = localisation;
  if (localisation.phase != global_map_t::PHASE_LOCALISED) return;
  const std::optional<Pose2> T_own_base = history_.At(localisation.utime);
  if (T_own_base) T_map_own_ = localisation.T_map_base * T_own_base->Inverse();
}

// T_start_own: by the map where the car began localised in it, else by dead reckoning alone.
Pose2 MissionManager::StartFromOwn() const {
  if (drive_->T_map_start && T_map_own_) return drive_->T_map_start->Inverse() * *T_map_own_;
  return drive_->T_own_start.Inverse();
}

bool MissionManager::TakeVelocity(int64_t utime, const Twist2& velocity) {
  if (!history_.Add(utime, velocity)) return false;
  if (drive_) {
    const Pose2 T_start_base = StartFromOwn() * *history_.At(utime);
    const bool localised =
        drive_->T_map_start && LocalisationProblem(std::max(utime, localisation_->now)).empty();
    drive_->laps.Move(T_start_base, history_.distance() - drive_->start_distance, localised);
  }
  return true;
}

bool MissionManager::TakeLocalMap(int64_t utime, const Pose2& T_local_base,
                                  std::vector<GateCone> cones) {
  const std::optional<Pose2> T_own_base = history_.At(utime);
  if (!T_own_base) return false;
  if (!drive_) return true;
  const Pose2 T_start_base = StartFromOwn() * *T_own_base;
  const Pose2 T_start_local = T_start_base * T_local_base.Inverse();
  for (GateCone& cone : cones) cone.position = T_start_local * cone.position;
  drive_->laps.Observe(cones, T_start_base, history_.distance() - drive_->start_distance);
  return true;
}

std::vector<std::string> MissionManager::SystemProblems(int64_t now) const {
  std::vector<std::string> problems = startup_.Problems(now);
  if (!supervision_) {
    problems.emplace_back("the watchdog was never heard");
  } else if (supervision_->blind) {
    problems.push_back("no perception pipeline is live: " + supervision_->reason);
  } else if (supervision_->stop) {
    problems.push_back("the watchdog asks for a stop: " + supervision_->reason);
  }
  if (mission_ == vehicle_t::MISSION_TRACKDRIVE) {
    std::string problem = LocalisationProblem(now);
    if (!problem.empty()) problems.push_back(std::move(problem));
  }
  return problems;
}

std::string MissionManager::LocalisationProblem(int64_t now) const {
  if (!localisation_) return "trackdrive: GLOBAL_MAP was never heard";
  if (SecondsBetween(localisation_->now, now) > params_.localisation_deadline) {
    return "trackdrive: GLOBAL_MAP is stale";
  }
  switch (localisation_->phase) {
    case global_map_t::PHASE_LOCALISED:
      return {};
    case global_map_t::PHASE_LOST:
      return "trackdrive: the car does not find itself on the map";
    default:
      return "trackdrive: no map is loaded";
  }
}

bool MissionManager::Stands(const VehicleReport& vehicle) {
  if (std::abs(vehicle.speed) >= params_.standstill_speed || moved_utime_ == 0) {
    moved_utime_ = vehicle.as.utime;
  }
  return SecondsBetween(moved_utime_, vehicle.as.utime) >= params_.standstill_time;
}

int MissionManager::LapsToDrive() const {
  switch (mission_) {
    case vehicle_t::MISSION_AUTOCROSS:
      return params_.autocross_laps;
    case vehicle_t::MISSION_TRACKDRIVE:
      return params_.trackdrive_laps;
    case vehicle_t::MISSION_ACCELERATION:
    case vehicle_t::MISSION_BRAKE_TEST:
      return 1;
    default:
      return 0;
  }
}

void MissionManager::BeginDrive() {
  const Pose2 T_own_start = history_.At(history_.newest_utime()).value_or(Pose2{});
  std::optional<Pose2> T_map_start;
  if (mission_ == vehicle_t::MISSION_TRACKDRIVE && T_map_own_)
    T_map_start = *T_map_own_ * T_own_start;
  // A brake test is driven on the same straight until the RES ends it, to the finish if it never
  // does.
  const bool straight =
      mission_ == vehicle_t::MISSION_ACCELERATION || mission_ == vehicle_t::MISSION_BRAKE_TEST;
  drive_.emplace(Drive{T_own_start, T_map_start, history_.distance(),
                       LapCounter(straight ? params_.acceleration : params_.laps), LapsToDrive()});
}

bool MissionManager::MissionFinished() const {
  return drive_ && drive_->laps.laps() >= drive_->laps_to_drive;
}

std::optional<MissionReport> MissionManager::Update(const VehicleReport& vehicle, int64_t now) {
  if (vehicle.as.utime <= last_utime_) return std::nullopt;
  last_utime_ = vehicle.as.utime;
  const AsState before = machine_.state();
  // From Go on the mission is the one that the car began with.
  if (before != AsState::kDriving && before != AsState::kFinished) mission_ = vehicle.as.mission;
  AsInput input = vehicle.as;
  input.mission_problem = MissionProblem(vehicle.as.mission);
  if (before != AsState::kDriving) {
    std::vector<std::string> problems = SystemProblems(now);
    if (!problems.empty()) input.system_problem = std::move(problems.front());
  }
  input.mission_finished = MissionFinished();
  input.standstill = Stands(vehicle);
  const AsState state = machine_.Update(input);
  if (state == AsState::kReady) drive_.reset();
  if (state == AsState::kDriving && before != AsState::kDriving) BeginDrive();
  MissionReport report;
  report.state = state;
  report.laps_to_drive = LapsToDrive();
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
         std::to_string(LapsToDrive());
}

}  // namespace hairpin
