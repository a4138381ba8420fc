#pragma once

#include <cstdint>

namespace hairpin {

/// Measures by a wall clock for how long nothing new was heard: the one case that data time cannot
/// see.
///
/// Counted is the time between calls of `Poll`, each step by at most 100 ms: what passes while the
/// process is not run (suspended, starved), or a jump of the clock, is no silence, for nothing
/// could have been heard.
class SilenceTimer {
 public:
  /// Silence from `limit_s` on; while it lasts it is announced each `repeat_s`.
  /// Throws std::invalid_argument unless both are > 0.
  SilenceTimer(double limit_s, double repeat_s);

  void Heard();
  /// True when silence is to be announced now. `now_micros` is the clock's time.
  bool Poll(int64_t now_micros);

  static constexpr int64_t kMaxStepMicros = 100'000;  // the daemon shell polls each 10 ms

 private:
  int64_t limit_micros_;
  int64_t repeat_micros_;
  bool polled_ = false;
  int64_t last_poll_micros_ = 0;
  int64_t silent_micros_ = 0;
  int64_t next_announcement_micros_;
};

}  // namespace hairpin
