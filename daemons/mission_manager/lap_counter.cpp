#include "daemons/mission_manager/lap_counter.hpp"

#include <numbers>
#include <string>

#include "common/require.hpp"

namespace hairpin {
namespace {

void Check(const LapCounterParams& params) {
  constexpr Require require("LapCounter");
  Check(params.gate);
  require(params.min_lap_length > 0.0, "min_lap_length_m must be > 0");
  require(params.course_length == 0.0 || params.course_length >= params.min_lap_length,
          "a course must be as long as min_lap_length_m");
  require(params.staging_distance >= 0.0, "staging_distance_m must be >= 0");
  require(params.start_within > params.staging_distance,
          "start_within_m must be > staging_distance_m");
  require(params.gate_margin >= 0.0, "gate_margin_m must be >= 0");
  require(params.gate_memory > 0.0, "gate_memory_m must be > 0");
  require(params.blind_tolerance > 0.0, "blind_tolerance_m must be > 0");
  require(params.blind_overrun >= 0.0, "blind_overrun_m must be >= 0");
  require(params.localised_overrun >= 0.0, "localised_overrun_m must be >= 0");
  require(params.max_heading_error > 0.0 && params.max_heading_error < std::numbers::pi / 2.0,
          "max_heading_error_rad must be from 0 to pi / 2");
}

}  // namespace

LapCounter::LapCounter(const LapCounterParams& params)
    : params_(params),
      gate_watch_(params.max_heading_error),
      reference_watch_(params.max_heading_error) {
  Check(params);
  // Dead reckoning starts at the start pose.
  reference_.centre = {params.staging_distance, 0.0};
}

void LapCounter::Observe(const std::vector<GateCone>& cones_own, const Pose2& T_own_base,
                         double distance) {
  const std::optional<StartLine> gate = FindGate(cones_own, T_own_base, params_.gate);
  if (!gate) return;
  gate_ = gate;
  gate_distance_ = distance;
}

void LapCounter::Move(const Pose2& T_own_base, double distance, bool localised) {
  if (gate_ && distance - gate_distance_ > params_.gate_memory) {
    gate_.reset();
    gate_watch_.Forget();
  }
  if (gate_) {
    blind_crossing_.reset();
    reference_watch_.Forget();
    const double tolerance = gate_->half_width + params_.gate_margin;
    if (gate_watch_.Crosses(*gate_, T_own_base, tolerance)) Cross(*gate_, distance);
  } else {
    MoveBlind(T_own_base, distance, localised);
  }
  // The line was behind the car, or never seen: the lap is on all the same.
  if (!started_ && distance >= params_.start_within) Cross(gate_ ? *gate_ : reference_, distance);
}

void LapCounter::MoveBlind(const Pose2& T_own_base, double distance, bool localised) {
  if (started_ && distance - crossed_distance_ < params_.min_lap_length) return;
  if (reference_watch_.Crosses(reference_, T_own_base, params_.blind_tolerance)) {
    blind_crossing_ = distance;
  }
  const double needed = localised ? params_.localised_overrun : params_.blind_overrun;
  const double overrun = started_ ? needed : 0.0;
  if (blind_crossing_ && distance - *blind_crossing_ >= overrun) Cross(reference_, distance);
}

void LapCounter::Cross(const StartLine& line, double distance) {
  // Also where it does not count: a gate just seen is a better line than the one reckoned.
  reference_ = line;
  reference_.centre += params_.course_length * line.direction;
  blind_crossing_.reset();
  if (started_ && distance - crossed_distance_ < params_.min_lap_length) return;
  if (started_) ++laps_;
  started_ = true;
  crossed_distance_ = distance;
}

}  // namespace hairpin
