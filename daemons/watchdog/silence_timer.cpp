#include "daemons/watchdog/silence_timer.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/clock.hpp"

namespace hairpin {

SilenceTimer::SilenceTimer(double limit_s, double repeat_s)
    : limit_micros_(AddSeconds(0, limit_s)),
      repeat_micros_(AddSeconds(0, repeat_s)),
      next_announcement_micros_(limit_micros_) {
  if (!(limit_s > 0.0)) throw std::invalid_argument("SilenceTimer: limit_s must be > 0");
  if (!(repeat_s > 0.0)) throw std::invalid_argument("SilenceTimer: repeat_s must be > 0");
}

void SilenceTimer::Heard() {
  silent_micros_ = 0;
  next_announcement_micros_ = limit_micros_;
}

bool SilenceTimer::Poll(int64_t now_micros) {
  const int64_t step = polled_ ? now_micros - last_poll_micros_ : 0;
  polled_ = true;
  last_poll_micros_ = now_micros;
  silent_micros_ += std::clamp<int64_t>(step, 0, kMaxStepMicros);
  if (silent_micros_ < next_announcement_micros_) return false;
  next_announcement_micros_ = silent_micros_ + repeat_micros_;
  return true;
}

}  // namespace hairpin
