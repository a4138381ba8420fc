#include "daemons/mission_manager/rate_monitor.hpp"

#include "common/clock.hpp"
#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr double kFlood = 4.0;  // times the nominal rate; more tells nothing more

}  // namespace

RateMonitor::RateMonitor(std::string channel, double rate, double deadline,
                         const RateMonitorParams& params)
    : channel_(std::move(channel)), rate_(rate), deadline_(deadline), params_(params) {
  constexpr Require require("RateMonitor");
  require(rate > 0.0, "rate_hz must be > 0");
  require(deadline > 0.0, "deadline_s must be > 0");
  require(params.window > 0.0, "ready_after_s must be > 0");
  require(params.min_share >= 0.0 && params.min_share <= 1.0, "min_rate_share must be from 0 to 1");
}

void RateMonitor::Heard(int64_t now) {
  if (!arrivals_.empty() && now < arrivals_.back()) return;
  if (arrivals_.empty() || SecondsBetween(arrivals_.back(), now) > deadline_) {
    arrivals_.clear();
    since_ = now;
  }
  arrivals_.push_back(now);
  if (static_cast<double>(arrivals_.size()) > kFlood * rate_ * params_.window + kFlood)
    arrivals_.pop_front();
  while (SecondsBetween(arrivals_.front(), now) > params_.window) arrivals_.pop_front();
}

std::string RateMonitor::Problem(int64_t now) const {
  if (arrivals_.empty()) return channel_ + " was never heard";
  if (SecondsBetween(arrivals_.back(), now) > deadline_) return channel_ + " is stale";
  if (SecondsBetween(since_, now) < params_.window) return channel_ + " has just begun";
  const double expected = rate_ * params_.window;
  if (static_cast<double>(arrivals_.size()) < params_.min_share * expected) {
    return channel_ + " is too slow";
  }
  return {};
}

}  // namespace hairpin
