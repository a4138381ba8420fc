#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/lidar_scan.hpp"
#include "common/pose_history.hpp"
#include "daemons/lidar_cone_detector/body_box.hpp"
#include "daemons/lidar_cone_detector/point_cloud.hpp"

namespace hairpin {

/// Where base was during the last moments before `utime`: T_base(utime)_base(utime - age), for ages
/// in steps of 0.2 ms, in which a car at 40 m/s moves 4 mm to either side.
class MotionTable {
 public:
  /// Empty where the velocity does not cover [utime - duration, utime], up to the history's
  /// extrapolation.
  static std::optional<MotionTable> Make(const PoseHistory& history, int64_t utime,
                                         double duration_s);

  struct Motion {
    float cosine, sine, x, y;
  };
  /// The nearest step; ages beyond the duration get the last.
  const Motion& At(float age) const {
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): lround, a call per point, is dearer
    const auto step = static_cast<size_t>(age * kPerSecond + 0.5f);
    return steps_[step < steps_.size() ? step : steps_.size() - 1];
  }

 private:
  static constexpr float kPerSecond = 5000.0f;
  std::vector<Motion> steps_;
};

/// Adds a scan's points to the cloud, in base at the cloud's time: each is taken to base at the
/// time of its firing by the sensor's mount, dropped if it lies on the car's own body, and carried
/// along by what the car moved since. `age_offset` [s]: how long before the cloud's time the scan's
/// utime was.
void Deskew(std::span<const LidarPoint> points, const Eigen::Isometry3f& T_base_sensor,
            float age_offset, const MotionTable& motion, const BodyBox& body, uint8_t sensor,
            PointCloud& cloud);

}  // namespace hairpin
