#include "tools/report/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "common/clock.hpp"

namespace hairpin {
namespace {

TrueState ToState(const truth_t& truth) {
  return {{truth.x_m, truth.y_m, truth.yaw_rad},
          {truth.vx_mps, truth.vy_mps, truth.yaw_rate_radps},
          truth.distance_m};
}

TrueState Interpolate(const TrueState& a, const TrueState& b, double share) {
  const Pose2& from = a.T_map_base;
  const Pose2& to = b.T_map_base;
  TrueState state;
  state.T_map_base = {std::lerp(from.x, to.x, share), std::lerp(from.y, to.y, share),
                      WrapAngle(from.yaw + share * WrapAngle(to.yaw - from.yaw))};
  state.velocity = {std::lerp(a.velocity.vx, b.velocity.vx, share),
                    std::lerp(a.velocity.vy, b.velocity.vy, share),
                    std::lerp(a.velocity.yaw_rate, b.velocity.yaw_rate, share)};
  state.distance = std::lerp(a.distance, b.distance, share);
  return state;
}

}  // namespace

std::optional<TrueState> TrueTrajectory::At(int64_t utime) const {
  const auto earlier = [](const truth_t& truth, int64_t time) { return truth.utime < time; };
  const auto next = std::lower_bound(truth_.begin(), truth_.end(), utime, earlier);
  if (next == truth_.end()) return std::nullopt;
  if (next->utime == utime) return ToState(*next);
  if (next == truth_.begin()) return std::nullopt;
  const truth_t& last = *(next - 1);
  const double gap = SecondsBetween(last.utime, next->utime);
  if (gap > kMaxTruthGap) return std::nullopt;
  return Interpolate(ToState(last), ToState(*next), SecondsBetween(last.utime, utime) / gap);
}

std::optional<int64_t> DrivingPhase::go_utime() const {
  const auto is_driving = [](const as_state_t& s) { return s.state == as_state_t::STATE_DRIVING; };
  const auto go = std::find_if(states_.begin(), states_.end(), is_driving);
  if (go == states_.end()) return std::nullopt;
  return go->utime;
}

bool DrivingPhase::IsDriving(int64_t utime) const {
  const auto earlier = [](int64_t time, const as_state_t& state) { return time < state.utime; };
  const auto next = std::upper_bound(states_.begin(), states_.end(), utime, earlier);
  if (next == states_.begin()) return false;
  const as_state_t& state = *(next - 1);
  return state.state == as_state_t::STATE_DRIVING && !state.mission_finished;
}

std::optional<Pose2> MomentaryMapFromLocal(const TrueTrajectory& trajectory, int64_t utime,
                                           const Pose2& T_local_base) {
  const auto state = trajectory.At(utime);
  if (!state) return std::nullopt;
  return state->T_map_base * T_local_base.Inverse();
}

}  // namespace hairpin
