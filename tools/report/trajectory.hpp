#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry.hpp"
#include "tools/report/run_log.hpp"

namespace hairpin {

/// Where the car truly was.
struct TrueState {
  Pose2 T_map_base;
  Twist2 velocity;        // base
  double distance = 0.0;  // driven since the start [m]
};

/// Truth farther apart than this says nothing of what was between [s].
inline constexpr double kMaxTruthGap = 0.5;

/// TRUTH at any time between its samples. Keeps a reference to the log.
class TrueTrajectory {
 public:
  explicit TrueTrajectory(const RunLog& log) : truth_(log.truth) {}
  /// Linear between the neighbouring samples, which cuts a bend by a dt^2 / 8: 2 cm at 1.5 g and
  /// 10 Hz. Empty outside the log and in gaps of more than kMaxTruthGap.
  std::optional<TrueState> At(int64_t utime) const;

 private:
  const std::vector<truth_t>& truth_;
};

/// When the car was under way by itself, from AS_STATE. Keeps a reference to the log.
class DrivingPhase {
 public:
  explicit DrivingPhase(const RunLog& log) : states_(log.as_states) {}
  /// First AS Driving; empty where the car never got its Go.
  std::optional<int64_t> go_utime() const;
  /// True while AS is Driving and the last lap is not yet done.
  bool IsDriving(int64_t utime) const;

 private:
  const std::vector<as_state_t>& states_;
};

/// T_map_local as it holds at `utime`: the true pose there against the dead-reckoned one, so that
/// what the car believes about its surroundings is judged without the drift of its odometry. Empty
/// where the truth is not known.
std::optional<Pose2> MomentaryMapFromLocal(const TrueTrajectory& trajectory, int64_t utime,
                                           const Pose2& T_local_base);

}  // namespace hairpin
