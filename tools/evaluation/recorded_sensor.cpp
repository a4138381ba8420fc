#include "tools/evaluation/recorded_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "daemons/lidar_cone_detector/body_box.hpp"

namespace hairpin {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kLowest = -22.05f * kPi / 180.0f;  // elevation of ring 0
constexpr float kRingStep = 0.345f * kPi / 180.0f;
constexpr float kAzimuthStep = 2.0f * kPi / 1024.0f;
constexpr float kRevolution = 0.05f;  // s
const Eigen::Vector3f kMount(1.03f, 0.0f, 0.49f);
// Where nothing but its own wings and wheels ever returned anything from above the ground.
constexpr BodyBox kBody{-3.0f, 1.6f, 0.95f};
constexpr float kPitch = -0.018f;  // looks up

// Where the point was in base when it was fired.
Eigen::Vector3f Skewed(const Eigen::Vector3f& point, const Twist2& velocity, float& age) {
  const float bearing = std::atan2(point.y(), point.x() - kMount.x());
  age = kRevolution * (bearing + kPi) / (2.0f * kPi);
  const Pose2 T_end_then = Integrate(velocity, static_cast<double>(-age));
  const Eigen::Vector2d then =
      T_end_then.Inverse() * Eigen::Vector2d(point.head<2>().cast<double>());
  return {static_cast<float>(then.x()), static_cast<float>(then.y()), point.z()};
}

}  // namespace

RecordedSensor::RecordedSensor()
    : T_base_sensor_(Eigen::Translation3f(kMount) *
                     Eigen::AngleAxisf(kPitch, Eigen::Vector3f::UnitY())),
      T_sensor_base_(T_base_sensor_.inverse()) {}

void RecordedSensor::ToCloud(const RecordedScan& scan, int keep_every, PointCloud& cloud) const {
  cloud.Clear();
  for (size_t i = 0; i < scan.x.size(); ++i) {
    const Eigen::Vector3f point(scan.x[i], scan.y[i], scan.z[i]);
    float age = 0.0f;
    const Eigen::Vector3f then = Skewed(point, scan.velocity, age);
    if (kBody.Contains(then.x(), then.y())) continue;
    const Eigen::Vector3f seen = T_sensor_base_ * then;
    const float elevation = std::atan2(seen.z(), seen.head<2>().norm());
    const int ring =
        std::clamp(static_cast<int>(std::lround((elevation - kLowest) / kRingStep)), 0, kRings - 1);
    if (ring % keep_every != 0) continue;
    cloud.Add(point, age, scan.intensity[i], static_cast<uint8_t>(ring / keep_every), 0);
  }
}

SensorGeometry RecordedSensor::Geometry(int keep_every) const {
  SensorGeometry geometry{T_base_sensor_, {}, kAzimuthStep};
  for (int ring = 0; ring < kRings; ring += keep_every)
    geometry.ring_elevation.push_back(kLowest + static_cast<float>(ring) * kRingStep);
  return geometry;
}

}  // namespace hairpin
