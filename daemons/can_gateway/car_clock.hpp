#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace hairpin {

/// The car's time as the bus tells it, so that a bus may run slower or faster than the wall. It
/// comes from CAR_TIME, advances with the sample times of protected frames in between, and goes on
/// by the wall's clock when the bus is silent or its time stands still.
///
/// `wall` is a monotonic clock in microseconds.
class CarClock {
 public:
  static constexpr double kSilence = 0.05;    // s of wall without a frame: the bus is silent
  static constexpr double kStandstill = 0.5;  // s of wall with frames whose time does not advance
  static constexpr double kMaxJump = 1.0;     // s; a CAR_TIME farther off must be said thrice
  static constexpr int kTimesToInsist = 3;
  static constexpr double kOldestSample = 0.2;   // s before car time
  static constexpr double kNewestSample = 0.15;  // s after it: CAR_TIME comes each 0.1 s

  /// A frame of whatever content was heard.
  void Heard(int64_t wall);
  /// CAR_TIME. Returns why it was refused, empty if it was not.
  std::string SetTime(int64_t utime, int64_t wall);
  /// The utime of a sample time; empty before the first CAR_TIME and for one too far from now.
  std::optional<int64_t> Unwrap(uint16_t sample_time) const;
  /// Something was measured at `utime`.
  void Advance(int64_t utime, int64_t wall);

  /// 0 before the first CAR_TIME.
  int64_t Now(int64_t wall) const;
  /// Wall time since the last frame [s]; 0 before the first.
  double Silence(int64_t wall) const;
  /// Goes up when time was set anew: what was measured before is of another time.
  int epoch() const { return epoch_; }

 private:
  int64_t newest_ = 0;
  int64_t heard_wall_ = 0;
  int64_t advanced_wall_ = 0;
  int64_t insisted_utime_ = 0;
  int insisted_ = 0;
  int epoch_ = 0;
};

}  // namespace hairpin
