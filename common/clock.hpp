#pragma once

#include <cstdint>

namespace hairpin {

/// Message times are int64 microseconds since the Unix epoch; durations inside C++ are seconds.
double SecondsBetween(int64_t earlier_utime, int64_t later_utime);
int64_t AddSeconds(int64_t utime, double seconds);

/// A monotonic wall clock. Only drivers, the CAN deadman and the watchdog own one, and it is
/// injected.
class Clock {
 public:
  virtual ~Clock() = default;
  /// Microseconds since an arbitrary start; never goes back.
  virtual int64_t NowMicros() const = 0;
};

class MonotonicClock final : public Clock {
 public:
  int64_t NowMicros() const override;
};

/// Stands still until it is moved: for tests and for runs whose only time is the log's.
class ManualClock final : public Clock {
 public:
  int64_t NowMicros() const override { return now_; }
  void Set(int64_t now_micros) { now_ = now_micros; }

 private:
  int64_t now_ = 0;
};

}  // namespace hairpin
