#include "common/pose_history.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/clock.hpp"

namespace hairpin {
namespace {

Twist2 Mean(const Twist2& a, const Twist2& b) {
  return {0.5 * (a.vx + b.vx), 0.5 * (a.vy + b.vy), 0.5 * (a.yaw_rate + b.yaw_rate)};
}

}  // namespace

PoseHistory::PoseHistory(double duration_s) : duration_(duration_s) {
  if (!(duration_s > 0.0)) throw std::invalid_argument("PoseHistory: duration_s must be > 0");
}

bool PoseHistory::Add(int64_t utime, const Twist2& velocity) {
  if (empty()) {
    samples_.push_back({utime, Pose2{}, velocity});
    return true;
  }
  const Sample& last = samples_.back();
  if (utime <= last.utime) return false;
  const double dt = SecondsBetween(last.utime, utime);
  const Twist2 mean = Mean(last.velocity, velocity);
  distance_ += std::hypot(mean.vx, mean.vy) * dt;
  samples_.push_back({utime, last.T_local_base * Integrate(mean, dt), velocity});
  // One sample older than the duration stays, so that the whole duration can be interpolated.
  while (samples_.size() > 2 && SecondsBetween(samples_[1].utime, utime) > duration_)
    samples_.pop_front();
  return true;
}

std::optional<Pose2> PoseHistory::At(int64_t utime) const {
  if (empty() || utime < samples_.front().utime) return std::nullopt;
  const auto after =
      std::upper_bound(samples_.begin(), samples_.end(), utime,
                       [](int64_t t, const Sample& sample) { return t < sample.utime; });
  const Sample& before = *std::prev(after);
  const double dt = SecondsBetween(before.utime, utime);
  if (after == samples_.end()) {
    if (dt > kMaxExtrapolation) return std::nullopt;
    return before.T_local_base * Integrate(before.velocity, dt);
  }
  return before.T_local_base * Integrate(Mean(before.velocity, after->velocity), dt);
}

}  // namespace hairpin
