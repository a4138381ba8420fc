#pragma once

#include <cstdint>
#include <optional>

namespace hairpin {

struct DriveGateParams {
  double as_state_deadline = 0.0;         // [s], > 0
  double pipeline_status_deadline = 0.0;  // [s], > 0
  double max_data_age = 0.0;              // of a path that the car may accelerate on [s], > 0
  double max_path_age = 0.0;              // of a path that it may still follow [s], >= max_data_age
  double stop_deceleration = 0.0;         // controlled stop [m/s2], > 0
  double finish_deceleration = 0.0;       // after the finish [m/s2], > 0
};

/// Newest word of the mission manager.
struct AsStateInput {
  int64_t utime = 0;
  bool driving = false;
  bool mission_finished = false;
};

/// Newest word of the watchdog.
struct PipelineStatusInput {
  int64_t utime = 0;
  bool stop = false;       // level or map mode ask for a controlled stop
  double speed_cap = 0.0;  // [m/s]
};

struct DriveGateInput {
  int64_t utime = 0;  // now, in data time
  bool velocity_valid = false;
  std::optional<AsStateInput> as_state;
  std::optional<PipelineStatusInput> pipeline_status;
  std::optional<int64_t> path_utime;  // of the newest path that was taken
};

enum class DriveAction { kHold, kDrive, kStop };

struct DriveDecision {
  DriveAction action = DriveAction::kHold;
  double deceleration = 0.0;  // brake at least this hard [m/s2]
  bool may_accelerate = false;
};

/// Whether the car drives, stops or is held: a pure function of who spoke when and what was said
/// [FAULTS 5, 24, 25].
///
/// * Not Driving: hold. Silence is no permission: never heard means not Driving.
/// * mission_manager or watchdog stale, controlled stop or no map mode asked for, velocity invalid,
/// no path, or a path older
///   than `max_path_age`: controlled stop.
/// * Mission finished: a comfortable stop.
/// * A path older than `max_data_age`: go on along it, but do not accelerate.
///
/// Nothing latches: the car goes on when the cause is gone, as long as the mission manager says
/// Driving.
DriveDecision Decide(const DriveGateInput& input, const DriveGateParams& params);

/// Throws std::invalid_argument for parameters out of their bounds.
void Check(const DriveGateParams& params);

}  // namespace hairpin
