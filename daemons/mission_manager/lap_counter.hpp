#pragma once

#include <optional>

#include "daemons/mission_manager/start_line.hpp"

namespace hairpin {

struct LapCounterParams {
  GateParams gate;
  double min_lap_length = 0.0;  // no lap is shorter [m], > 0
  double course_length =
      0.0;  // the finish lies so far ahead of the start [m]; 0: it is the same line
  double staging_distance = 0.0;  // from the start pose to the line, by the rules [m], >= 0
  double start_within =
      0.0;  // the first lap has begun at the latest after this [m], > staging_distance
  double gate_margin = 0.0;        // beside a gate that was seen [m], >= 0
  double gate_memory = 0.0;        // a gate not seen again is forgotten after this way [m], > 0
  double blind_tolerance = 0.0;    // beside the line found by dead reckoning [m], > 0
  double blind_overrun = 0.0;      // and so far on before the lap counts [m], >= 0
  double localised_overrun = 0.0;  // the same where the pose does not drift [m], >= 0
  double max_heading_error = 0.0;  // between car and line's direction [rad], 0 to pi / 2
};

/// Counts laps in the car's own dead-reckoned frame. The gate of large orange cones, seen near the
/// car, is the line: drift since the last crossing does not matter. Where none has been seen for
/// `gate_memory` metres (colour-blind modes), the line of the last crossing is used, or, before
/// any, the one that the rules put ahead of the start pose: within a tolerance that covers the
/// drift of a lap. Dead reckoning may be early, so the lap then counts only `blind_overrun` metres
/// on, when the true line is surely passed.
///
/// The first crossing starts the first lap; the next ones finish one each, at least
/// `min_lap_length` apart. On a course that does not return to its start line, the line that is
/// used where no gate is seen is reckoned ahead by its length.
class LapCounter {
 public:
  /// Throws std::invalid_argument for parameters out of their bounds.
  explicit LapCounter(const LapCounterParams& params);

  /// Large orange cones as seen when the car was at `T_own_base`, `distance` [m] driven; positions
  /// in the same frame.
  void Observe(const std::vector<GateCone>& cones_own, const Pose2& T_own_base, double distance);
  /// The car is at `T_own_base` now, `distance` [m] driven; `localised`: in a map, without drift.
  void Move(const Pose2& T_own_base, double distance, bool localised = false);

  bool started() const { return started_; }
  int laps() const { return laps_; }
  /// The gate in use now; empty where none was seen lately.
  const std::optional<StartLine>& gate() const { return gate_; }

 private:
  void Cross(const StartLine& line, double distance);
  void MoveBlind(const Pose2& T_own_base, double distance, bool localised);

  LapCounterParams params_;
  std::optional<StartLine> gate_;
  double gate_distance_ = 0.0;  // when it was seen last
  StartLine reference_;         // for when no gate is seen
  CrossingWatch gate_watch_;
  CrossingWatch reference_watch_;
  bool started_ = false;
  int laps_ = 0;
  double crossed_distance_ = 0.0;         // at the last crossing
  std::optional<double> blind_crossing_;  // distance at a crossing that waits for the overrun
};

}  // namespace hairpin
