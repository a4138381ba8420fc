#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "common/geometry.hpp"
#include "tests/support/lidar_world.hpp"
#include "tools/simulator/lidar/velodyne_encoder.hpp"

namespace hairpin {

/// A VLP-32C turned so fast that a revolution is 1800 firing sequences: 57,600 firings in 150 data
/// packets.
inline constexpr int kTurnSequences = 1800;
inline constexpr int kTurnPackets = kTurnSequences / 12;

/// What a blue cone's stripe sends back at a height, of what else stands there.
inline float ReflectivityIn(const LidarWorld& world, int hit, float height) {
  if (hit < 0) return hit == kHitGround ? 0.16f : 0.5f;
  const bool stripe = height > 0.14f && height < 0.23f;
  const bool blue = world.cones[static_cast<size_t>(hit)].position.y() > 0.0f;
  if (blue) return stripe ? 0.75f : 0.15f;
  return stripe ? 0.06f : 0.6f;
}

/// The data packets of one revolution that begins at `start_azimuth` (clockwise from ahead [rad])
/// and at `epoch_us`, from a car that drives straight on at `speed` [m/s], each laser at its own
/// time and place. `noise` [m]: of each range.
inline std::vector<VelodyneDataPacket> TurnPackets(const LidarWorld& world,
                                                   const Eigen::Isometry3f& T_base_sensor,
                                                   double start_azimuth, double speed, float noise,
                                                   int64_t epoch_us) {
  const LidarModel model = Vlp32c();
  std::mt19937 random(1);
  std::normal_distribution<float> gauss(0.0f, noise);
  VelodyneEncoder encoder(epoch_us);
  std::vector<VelodyneDataPacket> packets;
  for (int number = 0; number < kTurnSequences; ++number) {
    FiringSequence sequence;
    sequence.start_ns = number * model.sequence_ns;
    const double turn = 2.0 * std::numbers::pi / kTurnSequences;
    sequence.azimuth_rad = start_azimuth + number * turn;
    for (const Laser& laser : model.lasers) {
      const auto ns = static_cast<double>(sequence.start_ns + laser.firing_ns);
      const double turned = static_cast<double>(laser.firing_ns) * turn;
      const double azimuth = sequence.azimuth_rad +
                             turned / static_cast<double>(model.sequence_ns) + laser.azimuth_offset;
      const Eigen::Vector3d beam(std::cos(laser.elevation) * std::cos(azimuth),
                                 -std::cos(laser.elevation) * std::sin(azimuth),
                                 std::sin(laser.elevation));
      Eigen::Vector3f origin = T_base_sensor.translation();
      origin.x() += static_cast<float>(speed * ns * 1e-9);
      const Eigen::Vector3f direction = T_base_sensor.linear() * beam.cast<float>();
      const auto hit = lidar_world_detail::Cast(world, origin, direction);
      LidarReturn& echo = sequence.returns.emplace_back();
      if (!hit) continue;
      const Eigen::Vector3f point = origin + hit->distance * direction;
      echo.range = hit->distance + gauss(random);
      echo.reflectivity =
          ReflectivityIn(world, hit->what, point.z() - world.GroundAt(point.x(), point.y()));
    }
    if (const auto packet = encoder.Add(sequence)) packets.push_back(*packet);
  }
  return packets;
}

}  // namespace hairpin
