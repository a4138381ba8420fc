#include "daemons/lidar_cone_detector/deskew.hpp"

#include <cmath>

#include "common/clock.hpp"

namespace hairpin {

std::optional<MotionTable> MotionTable::Make(const PoseHistory& history, int64_t utime,
                                             double duration_s) {
  const std::optional<Pose2> T_local_now = history.At(utime);
  if (!T_local_now) return std::nullopt;
  const Pose2 T_now_local = T_local_now->Inverse();
  MotionTable table;
  const auto count = static_cast<int>(std::ceil(duration_s * static_cast<double>(kPerSecond))) + 1;
  table.steps_.reserve(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    const int64_t then = AddSeconds(utime, -i / static_cast<double>(kPerSecond));
    const std::optional<Pose2> T_local_then = history.At(then);
    if (!T_local_then) return std::nullopt;
    const Pose2 T_now_then = T_now_local * *T_local_then;
    table.steps_.push_back({static_cast<float>(std::cos(T_now_then.yaw)),
                            static_cast<float>(std::sin(T_now_then.yaw)),
                            static_cast<float>(T_now_then.x), static_cast<float>(T_now_then.y)});
  }
  return table;
}

void Deskew(std::span<const LidarPoint> points, const Eigen::Isometry3f& T_base_sensor,
            float age_offset, const MotionTable& motion, const BodyBox& body, uint8_t sensor,
            PointCloud& cloud) {
  const Eigen::Matrix3f rotation = T_base_sensor.linear();
  const Eigen::Vector3f offset = T_base_sensor.translation();
  size_t count = cloud.size();
  cloud.Resize(count + points.size());
  for (const LidarPoint& point : points) {
    const Eigen::Vector3f then = rotation * point.position + offset;
    if (body.Contains(then.x(), then.y())) continue;
    const float age = point.age + age_offset;
    const MotionTable::Motion& m = motion.At(age);
    cloud.Set(count++,
              {m.cosine * then.x() - m.sine * then.y() + m.x,
               m.sine * then.x() + m.cosine * then.y() + m.y, then.z()},
              age, point.intensity, point.ring, sensor);
  }
  cloud.Resize(count);
}

}  // namespace hairpin
