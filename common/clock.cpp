#include "common/clock.hpp"

#include <chrono>
#include <cmath>

namespace hairpin {

double SecondsBetween(int64_t earlier_utime, int64_t later_utime) {
  return static_cast<double>(later_utime - earlier_utime) * 1e-6;
}

int64_t AddSeconds(int64_t utime, double seconds) { return utime + std::llround(seconds * 1e6); }

int64_t MonotonicClock::NowMicros() const {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

}  // namespace hairpin
