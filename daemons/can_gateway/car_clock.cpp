#include "daemons/can_gateway/car_clock.hpp"

#include <algorithm>
#include <cmath>

#include "common/can/sample_time.hpp"
#include "common/clock.hpp"

namespace hairpin {

void CarClock::Heard(int64_t wall) { heard_wall_ = std::max(heard_wall_, wall); }

std::string CarClock::SetTime(int64_t utime, int64_t wall) {
  if (newest_ == 0 || std::abs(SecondsBetween(newest_, utime)) <= kMaxJump) {
    insisted_ = 0;
    if (newest_ == 0) ++epoch_;
    Advance(utime, wall);
    return {};
  }
  const double step = SecondsBetween(insisted_utime_, utime);
  insisted_ = insisted_ > 0 && step >= 0.0 && step <= kMaxJump ? insisted_ + 1 : 1;
  insisted_utime_ = utime;
  if (insisted_ < kTimesToInsist) return "time jumps";
  insisted_ = 0;
  ++epoch_;
  newest_ = utime;
  advanced_wall_ = wall;
  return {};
}

std::optional<int64_t> CarClock::Unwrap(uint16_t sample_time) const {
  if (newest_ == 0) return std::nullopt;
  const int64_t utime = FromSampleTime(sample_time, newest_);
  const double ahead = SecondsBetween(newest_, utime);
  if (ahead < -kOldestSample || ahead > kNewestSample) return std::nullopt;
  return utime;
}

void CarClock::Advance(int64_t utime, int64_t wall) {
  if (utime <= newest_) return;
  newest_ = utime;
  advanced_wall_ = wall;
}

int64_t CarClock::Now(int64_t wall) const {
  if (newest_ == 0) return 0;
  if (Silence(wall) > kSilence) return newest_ + (wall - heard_wall_);
  const bool stands_still = SecondsBetween(advanced_wall_, wall) > kStandstill;
  return stands_still ? newest_ + (wall - advanced_wall_) : newest_;
}

double CarClock::Silence(int64_t wall) const {
  return heard_wall_ == 0 ? 0.0 : SecondsBetween(heard_wall_, wall);
}

}  // namespace hairpin
