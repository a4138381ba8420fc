#include "daemons/lidar_driver/clock_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/clock.hpp"

namespace hairpin {
namespace {

constexpr size_t kMaxSamples = 1000;

}  // namespace

ClockMonitor::ClockMonitor(double window_s) : window_s_(window_s) {
  if (!(window_s > 0.0)) throw std::invalid_argument("ClockMonitor: window_s must be > 0");
}

void ClockMonitor::Hear(int64_t lidar_utime, int64_t reference_utime) {
  // The reference's time may begin anew, as in a replay.
  if (!samples_.empty() && reference_utime <= samples_.back().reference_utime) {
    samples_.clear();
    full_ = false;
  }
  samples_.push_back({reference_utime, SecondsBetween(reference_utime, lidar_utime)});
  while (samples_.size() > kMaxSamples ||
         SecondsBetween(samples_.front().reference_utime, reference_utime) > window_s_) {
    samples_.pop_front();
    full_ = true;
  }
}

std::optional<double> ClockMonitor::error() const {
  if (!full_) return std::nullopt;
  const auto nearest =
      std::min_element(samples_.begin(), samples_.end(), [](const Sample& a, const Sample& b) {
        return std::abs(a.difference) < std::abs(b.difference);
      });
  return nearest->difference;
}

}  // namespace hairpin
