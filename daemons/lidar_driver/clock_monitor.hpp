#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace hairpin {

/// How far a LiDAR's clock is ahead of another sensor's, from what arrives when: at the moment that
/// a message of the other is heard, the newest packet should be about as old. A wait anywhere on
/// the way only ever makes the two look further apart, so that of all differences within the window
/// the smallest counts.
class ClockMonitor {
 public:
  /// Throws std::invalid_argument unless window_s > 0.
  explicit ClockMonitor(double window_s);

  /// The reference was heard, stamped `reference_utime`, while the newest firing was that of
  /// `lidar_utime`.
  void Hear(int64_t lidar_utime, int64_t reference_utime);

  /// Error of the LiDAR's clock [s]; empty until a window is full.
  std::optional<double> error() const;

 private:
  struct Sample {
    int64_t reference_utime;
    double difference;
  };
  double window_s_;
  std::deque<Sample> samples_;  // of the window, at most kMaxSamples
  bool full_ = false;
};

}  // namespace hairpin
