#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "common/pose_history.hpp"
#include "daemons/mission_manager/as_state_machine.hpp"
#include "daemons/mission_manager/lap_counter.hpp"
#include "daemons/mission_manager/startup_checks.hpp"

namespace hairpin {

struct MissionManagerParams {
  StartupParams startup;
  LapCounterParams laps;
  LapCounterParams acceleration;       // the same for a straight course
  double go_delay = 0.0;               // [s], >= 0
  int autocross_laps = 0;              // >= 1
  int trackdrive_laps = 0;             // >= 1
  double localisation_deadline = 0.0;  // of GLOBAL_MAP [s], > 0
  double standstill_speed = 0.0;       // [m/s], > 0
  double standstill_time = 0.0;        // slower than that for so long is standing [s], >= 0
  double history = 0.0;                // of poses, longer than a local map is late [s], > 0
};

/// Switches, brakes and RES; `as` leaves out what this class adds itself.
struct VehicleReport {
  AsInput as;
  double speed = 0.0;  // [m/s]
};

/// Newest word of the watchdog.
struct SupervisionInput {
  bool blind = false;  // no map mode
  bool stop = false;   // a controlled stop or more is asked for
  std::string reason;
};

/// Newest word of the global mapper.
struct LocalisationInput {
  int64_t utime = 0;  // of the pose
  int64_t now = 0;    // data time when it was heard
  int32_t phase = 0;  // as in global_map_t
  Pose2 T_map_base;
};

/// State of the mission; fields as in as_state_t.
struct MissionReport {
  AsState state = AsState::kOff;
  int laps = 0;
  int laps_to_drive = 0;
  bool mission_finished = false;
  double distance = 0.0;  // [m]
  std::string reason;
};

/// Starts, counts and ends the mission: the rules' state machine fed with whether the software
/// runs, and a lap counter fed with dead reckoning and the cones of the local map. The start pose
/// is where the car stands when Driving begins.
class MissionManager {
 public:
  /// Throws std::invalid_argument for parameters out of their bounds.
  explicit MissionManager(const MissionManagerParams& params);

  /// What happens on channels, in daemons and in the computer.
  StartupChecks& startup() { return startup_; }
  void TakeSupervision(const SupervisionInput& supervision) { supervision_ = supervision; }
  /// In a trackdrive the pose in a known map takes the drift out of dead reckoning.
  void TakeLocalisation(const LocalisationInput& localisation);
  /// Returns false, and ignores it, where the time does not increase.
  bool TakeVelocity(int64_t utime, const Twist2& velocity);
  /// Cones in the mapper's local frame, with the pose that it had at `utime`. Returns false, and
  /// ignores it, where the time is outside the pose history.
  bool TakeLocalMap(int64_t utime, const Pose2& T_local_base, std::vector<GateCone> cones_local);

  /// The state when data time is `now`. Returns empty where the vehicle's time does not increase.
  std::optional<MissionReport> Update(const VehicleReport& vehicle, int64_t now);
  /// All that keeps the car from Ready when data time is `now`, as far as it is the software.
  std::vector<std::string> SystemProblems(int64_t now) const;

 private:
  /// The drive that began with Driving.
  struct Drive {
    Pose2 T_own_start;
    std::optional<Pose2> T_map_start;  // where the car is localised
    double start_distance;
    LapCounter laps;
    int laps_to_drive;
  };

  Pose2 StartFromOwn() const;
  std::string LocalisationProblem(int64_t now) const;
  bool Stands(const VehicleReport& vehicle);
  int LapsToDrive() const;
  void BeginDrive();
  bool MissionFinished() const;
  std::string Reason() const;

  MissionManagerParams params_;
  AsStateMachine machine_;
  PoseHistory history_;
  StartupChecks startup_;
  std::optional<SupervisionInput> supervision_;
  std::optional<LocalisationInput> localisation_;
  std::optional<Pose2> T_map_own_;  // by the newest pose in the known map
  int32_t mission_ = 0;             // as in vehicle_t
  std::optional<Drive> drive_;
  int64_t last_utime_ = 0;
  int64_t moved_utime_ = 0;  // when the car was last not slow
};

}  // namespace hairpin
