#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/geometry.hpp"

namespace hairpin {

/// Dead reckoning: poses of base in local, by integration of the velocity from {0, 0, 0} [paper
/// III-C, local map]. Keeps the last `duration` seconds, so that a delayed observation finds the
/// pose of its own time.
class PoseHistory {
 public:
  /// Throws std::invalid_argument unless duration > 0.
  explicit PoseHistory(double duration_s);

  /// Moves to `utime` with the mean of the last and this velocity (trapezoidal). Returns false, and
  /// changes nothing, where `utime` does not increase.
  bool Add(int64_t utime, const Twist2& velocity);

  /// T_local_base at `utime`, interpolated along the arc driven. Up to `kMaxExtrapolation` past the
  /// newest velocity it goes on with that velocity. Empty: before the history, too far past it, or
  /// no velocity yet.
  std::optional<Pose2> At(int64_t utime) const;

  bool empty() const { return samples_.empty(); }
  /// Newest time held; 0 when empty.
  int64_t newest_utime() const { return empty() ? 0 : samples_.back().utime; }
  /// Distance driven since the start [m].
  double distance() const { return distance_; }

  static constexpr double kMaxExtrapolation = 0.1;  // s: ten periods of VELOCITY

 private:
  struct Sample {
    int64_t utime;
    Pose2 T_local_base;
    Twist2 velocity;
  };

  double duration_;
  double distance_ = 0.0;
  std::deque<Sample> samples_;
};

}  // namespace hairpin
