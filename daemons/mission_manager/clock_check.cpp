#include "daemons/mission_manager/clock_check.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/clock.hpp"

namespace hairpin {

ClockCheck::ClockCheck(const std::vector<ClockedSensor>& sensors, double window)
    : window_micros_(AddSeconds(0, window)) {
  if (window_micros_ <= 0) throw std::invalid_argument("ClockCheck: the window must be > 0");
  for (const ClockedSensor& sensor : sensors) {
    if (!(sensor.tolerance > 0.0))
      throw std::invalid_argument("ClockCheck: " + sensor.channel + ": tolerance must be > 0");
    delays_[sensor.channel].tolerance = sensor.tolerance;
  }
}

void ClockCheck::Heard(const std::string& channel, int64_t utime, int64_t now) {
  const auto found = delays_.find(channel);
  if (found == delays_.end()) return;
  Delay& delay = found->second;
  const double seconds = SecondsBetween(utime, now);
  const int64_t window = now / window_micros_;
  if (window != delay.window) {
    delay.before = window == delay.window + 1 && delay.window >= 0 ? delay.least : seconds;
    delay.least = seconds;
    delay.window = window;
  }
  delay.least = std::min(delay.least, seconds);
}

std::vector<std::string> ClockCheck::Problems() const {
  std::vector<double> delays;
  for (const auto& [channel, delay] : delays_) {
    if (delay.window >= 0) delays.push_back(std::min(delay.least, delay.before));
  }
  if (delays.size() < 3) return {};
  const auto middle = delays.begin() + static_cast<std::ptrdiff_t>(delays.size() / 2);
  std::nth_element(delays.begin(), middle, delays.end());
  const double median = *middle;
  std::vector<std::string> problems;
  for (const auto& [channel, delay] : delays_) {
    if (delay.window < 0) continue;
    const double behind = std::min(delay.least, delay.before) - median;
    if (std::abs(behind) <= delay.tolerance) continue;
    problems.push_back("the clock of " + channel + " is " +
                       std::to_string(std::lround(1e3 * std::abs(behind))) + " ms " +
                       (behind > 0.0 ? "behind" : "ahead of") + " the others");
  }
  return problems;
}

}  // namespace hairpin
