#pragma once

#include <chrono>
#include <vector>

#include "daemons/lidar_cone_detector/lidar_cone_detector.hpp"

namespace hairpin {

/// Wall time of the detector's stages [ms].
class Stopwatch {
 public:
  void Record(DetectorStage stage) {
    const Clock::time_point now = Clock::now();
    if (stage == DetectorStage::kStart) {
      laps_.clear();
      start_ = now;
    } else {
      laps_.push_back(Milliseconds(now - last_));
    }
    last_ = now;
  }
  /// Each stage of the last detection, and all of them together.
  std::vector<double> Laps() const {
    std::vector<double> laps = laps_;
    laps.push_back(Milliseconds(last_ - start_));
    return laps;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double Milliseconds(Clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
  }
  Clock::time_point start_, last_;
  std::vector<double> laps_;
};

}  // namespace hairpin
