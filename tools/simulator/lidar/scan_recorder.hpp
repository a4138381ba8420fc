#pragma once

#include <optional>
#include <vector>

#include "common/lidar_scan.hpp"
#include "tools/simulator/lidar/lidar_sensor.hpp"

namespace hairpin {

/// Collects the sequences of one sensor into revolutions, as the driver would without a wire in
/// between: for recordings of scans, and as the truth that decoded packets are compared with.
class ScanRecorder {
 public:
  /// `epoch_us`: time that the sequences' times count from.
  ScanRecorder(const LidarSensorParams& params, int64_t epoch_us);
  /// Adds a sequence; gives back the revolution that ends before it, where the head passes azimuth
  /// pi (backward).
  std::optional<lidar_scan_t> Add(const FiringSequence& sequence);

 private:
  lidar_scan_t Finish() const;

  struct Point {
    LidarPoint point;
    int64_t time_ns;
  };
  LidarSensorParams params_;
  int64_t epoch_us_;
  std::vector<uint8_t> ring_;  // by channel
  std::vector<float> elevation_;
  std::vector<Point> points_;
  double last_azimuth_ = 0.0;
};

}  // namespace hairpin
