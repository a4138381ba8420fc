#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "common/lidar_scan.hpp"
#include "daemons/lidar_cone_detector/cone_body.hpp"
#include "daemons/lidar_cone_detector/point_cloud.hpp"

namespace hairpin {

/// A small world for a rotating LiDAR, cast exactly: tilted ground, cones as truncated cones,
/// upright walls. Each return knows what it hit.
struct LidarWorld {
  struct Cone {
    Eigen::Vector2f position;
    ConeBody body{0.325, 0.085, 0.025};
  };
  struct Wall {  // upright, as high as the scene
    Eigen::Vector2f from, to;
    float height;
  };
  float ground = 0.0f, slope_x = 0.0f, slope_y = 0.0f;
  std::vector<Cone> cones;
  std::vector<Wall> walls;

  float GroundAt(float x, float y) const { return ground + slope_x * x + slope_y * y; }
};

inline constexpr int kHitGround = -1;
inline constexpr int kHitWall = -2;

struct LabelledCloud {
  PointCloud cloud;
  std::vector<int> hit;  // number of the cone, kHitGround or kHitWall
};

namespace lidar_world_detail {

struct Hit {
  float distance;
  int what;
};

inline void Nearer(std::optional<Hit>& best, float distance, int what) {
  if (distance > 0.3f && (!best || distance < best->distance)) best = Hit{distance, what};
}

inline void HitCone(const LidarWorld& world, int number, const Eigen::Vector3f& o,
                    const Eigen::Vector3f& d, std::optional<Hit>& best) {
  const LidarWorld::Cone& cone = world.cones[static_cast<size_t>(number)];
  const float foot = world.GroundAt(cone.position.x(), cone.position.y());
  // |p - axis|^2 = (r0 + k (z - foot))^2 along p = o + t d: a quadratic in t.
  const auto height = static_cast<float>(cone.body.height);
  const auto r0 = static_cast<float>(cone.body.foot_radius);
  const float k = (static_cast<float>(cone.body.top_radius) - r0) / height;
  const Eigen::Vector2f q = o.head<2>() - cone.position;
  const float r = r0 + k * (o.z() - foot);
  const float a = d.head<2>().squaredNorm() - k * k * d.z() * d.z();
  const float b = q.dot(d.head<2>()) - k * d.z() * r;
  const float c = q.squaredNorm() - r * r;
  const float root = b * b - a * c;
  if (root < 0.0f) return;
  const float t = (-b - std::sqrt(root)) / a;
  const float above = o.z() + t * d.z() - foot;
  if (above >= 0.0f && above <= height) Nearer(best, t, number);
}

inline void HitWall(const LidarWorld& world, const LidarWorld::Wall& wall, const Eigen::Vector3f& o,
                    const Eigen::Vector3f& d, std::optional<Hit>& best) {
  const Eigen::Vector2f along = wall.to - wall.from;
  const Eigen::Vector2f q = wall.from - o.head<2>();
  const float cross = d.x() * along.y() - d.y() * along.x();
  if (std::abs(cross) < 1e-9f) return;
  const float t = (q.x() * along.y() - q.y() * along.x()) / cross;
  const float s = (q.x() * d.y() - q.y() * d.x()) / cross;
  const Eigen::Vector3f p = o + t * d;
  if (s >= 0.0f && s <= 1.0f && p.z() - world.GroundAt(p.x(), p.y()) <= wall.height)
    Nearer(best, t, kHitWall);
}

inline std::optional<Hit> Cast(const LidarWorld& world, const Eigen::Vector3f& o,
                               const Eigen::Vector3f& d) {
  std::optional<Hit> best;
  const float fall = d.z() - world.slope_x * d.x() - world.slope_y * d.y();
  if (fall < -1e-6f) Nearer(best, (world.GroundAt(o.x(), o.y()) - o.z()) / fall, kHitGround);
  for (size_t i = 0; i < world.cones.size(); ++i) HitCone(world, static_cast<int>(i), o, d, best);
  for (const LidarWorld::Wall& wall : world.walls) HitWall(world, wall, o, d, best);
  return best;
}

}  // namespace lidar_world_detail

/// One revolution of a sensor that stands still. `noise` [m]: of each range.
inline LabelledCloud Scan(const LidarWorld& world, const SensorGeometry& sensor, float noise,
                          float max_range, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> gauss(0.0f, std::max(noise, 1e-9f));
  LabelledCloud scan;
  const Eigen::Vector3f origin = sensor.T_base_sensor.translation();
  constexpr float kPi = std::numbers::pi_v<float>;
  const int steps = static_cast<int>(std::lround(2.0f * kPi / sensor.azimuth_step));
  for (int step = 0; step < steps; ++step) {
    const float azimuth = kPi - static_cast<float>(step) * sensor.azimuth_step;
    for (size_t ring = 0; ring < sensor.ring_elevation.size(); ++ring) {
      const float elevation = sensor.ring_elevation[ring];
      const Eigen::Vector3f beam(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3f direction = sensor.T_base_sensor.linear() * beam;
      const auto hit = lidar_world_detail::Cast(world, origin, direction);
      if (!hit || hit->distance > max_range) continue;
      const Eigen::Vector3f point = origin + (hit->distance + gauss(random)) * direction;
      scan.cloud.Add(point, 0.0f, 50, static_cast<uint8_t>(ring), 0);
      scan.hit.push_back(hit->what);
    }
  }
  return scan;
}

/// 32 rings as a VLP-32C has them: a third of a degree apart about the horizon, up to several
/// degrees below (Velodyne, VLP-32C user manual, elevation angles).
inline SensorGeometry UnevenSensor(const Eigen::Vector3f& position, float azimuth_step_deg) {
  SensorGeometry sensor;
  sensor.T_base_sensor.translation() = position;
  for (const float degrees :
       {-25.0f,  -15.639f, -11.31f, -8.843f, -7.254f, -6.148f, -5.333f, -4.667f,
        -4.0f,   -3.667f,  -3.333f, -3.0f,   -2.667f, -2.333f, -2.0f,   -1.667f,
        -1.333f, -1.0f,    -0.667f, -0.333f, 0.0f,    0.333f,  0.667f,  1.0f,
        1.333f,  1.667f,   2.333f,  3.333f,  4.667f,  7.0f,    10.333f, 15.0f})
    sensor.ring_elevation.push_back(degrees * std::numbers::pi_v<float> / 180.0f);
  sensor.azimuth_step = azimuth_step_deg * std::numbers::pi_v<float> / 180.0f;
  return sensor;
}

/// A lane of cones to both sides with walls beside it: `count` cones from 3 m on.
inline LidarWorld LaneBetweenWalls(int count) {
  LidarWorld world;
  for (int i = 0; i < count; ++i) {
    const auto along = static_cast<float>(i / 2);
    world.cones.push_back({{3.0f + 2.0f * along, i % 2 == 0 ? 1.7f : -1.6f}});
  }
  world.walls = {{{-15.0f, 6.0f}, {25.0f, 7.0f}, 1.0f},
                 {{-15.0f, -7.0f}, {25.0f, -6.0f}, 1.0f},
                 {{22.0f, -8.0f}, {22.0f, 8.0f}, 1.5f},
                 {{-12.0f, -8.0f}, {-12.0f, 8.0f}, 3.0f}};
  return world;
}

}  // namespace hairpin
