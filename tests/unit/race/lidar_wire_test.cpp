// The simulated sensors' packets, read by the car's own driver: written apart, they must agree.
#include <gtest/gtest.h>

#include <numbers>

#include "daemons/lidar_driver/lidar_driver_node.hpp"
#include "tests/support/oval_track.hpp"
#include "tests/support/simulator_setup.hpp"
#include "tools/simulator/lidar/centre_drive.hpp"
#include "tools/simulator/simulator.hpp"
#include "tools/simulator/track_geometry.hpp"

namespace hairpin {
namespace {

LidarDriverNodeParams ShippedDriver(const std::string& instance) {
  return LoadLidarDriverParams(
      Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "lidar_driver"), instance);
}

// Runs the rig for `ticks` of 10 ms, packets of `sensor` going to `sink`.
void Drive(const std::string& sensor, int ticks,
           const std::function<void(std::span<const uint8_t>)>& sink,
           const std::function<void(const LidarSensorParams&, const FiringSequence&)>& truth) {
  const Track track = OvalTrack();
  const LidarRigParams params = ShippedSimulatorParams().lidars;
  LidarRig rig(params, ShippedCar(), track, 1, Simulator::kFirstUtime,
               [&](const std::string& from, LidarRig::Port, std::span<const uint8_t> packet) {
                 if (from == sensor) sink(packet);
               });
  rig.OnSequence([&](const std::string& from, const FiringSequence& sequence) {
    if (from == sensor && truth) truth(params.sensor, sequence);
  });
  const CentreDrive drive(track, 5.0);
  for (int tick = 0; tick <= ticks; ++tick)
    rig.Advance(Simulator::kFirstUtime + 10'000 * tick, drive.At(0.01 * tick), AllCones(track));
}

TEST(LidarWire, DecodesToTheRangesDirectionsAndTimesThatWereCast) {
  const LidarDriverNodeParams driver = ShippedDriver("front");
  const VelodyneDecoder decoder(driver.sensor);
  std::vector<Eigen::Vector3d> cast;
  std::vector<uint8_t> intensity;
  std::vector<LidarPoint> decoded;
  Drive(
      "lidar_front", 12,
      [&](std::span<const uint8_t> packet) {
        if (!decoder.IsDataSize(packet.size())) return;
        DecodedPacket result;
        const auto refused = decoder.Decode(packet, result);
        ASSERT_FALSE(refused) << refused->what;
        decoded.insert(decoded.end(), result.points.begin(), result.points.end());
      },
      [&](const LidarSensorParams& sensor, const FiringSequence& sequence) {
        for (size_t i = 0; i < sequence.returns.size(); ++i) {
          const Laser& laser = sensor.model.lasers[i];
          const double range = sequence.returns[i].range;
          if (range < driver.sensor.min_range || range > driver.sensor.max_range) continue;
          const double turn = sensor.rotation_hz * 2.0 * std::numbers::pi * 1e-9 *
                              static_cast<double>(laser.firing_ns);
          cast.push_back(range * BeamDirection(laser.elevation,
                                               sequence.azimuth_rad + turn + laser.azimuth_offset));
          intensity.push_back(ReflectivityByte(sequence.returns[i].reflectivity));
        }
      });
  ASSERT_GT(decoded.size(), 25'000u);
  ASSERT_LE(decoded.size(), cast.size());  // the last packet is not full yet
  for (size_t i = 0; i < decoded.size(); ++i) {
    const Eigen::Vector3d point = decoded[i].position.cast<double>();
    // Ranges are sent in steps of 4 mm, azimuths of 0.01 deg.
    ASSERT_NEAR(point.norm(), cast[i].norm(), 0.0021) << i;
    ASSERT_LT((point.normalized() - cast[i].normalized()).norm(), 2.5e-4) << i;
    ASSERT_EQ(decoded[i].intensity, intensity[i]) << i;
  }
}

TEST(LidarWire, TheDriverPublishesRevolutionsWithTheSimulatorsTime) {
  Transport transport("memq://");
  Bus driver_bus(transport, "lidar_driver_front", 1);
  Bus listener(transport, "listener", 1);
  LidarDriverNode node(ShippedDriver("front"), "front", driver_bus);
  std::vector<lidar_scan_t> scans;
  listener.Subscribe(channels::kLidarFront,
                     [&](const lidar_scan_t& scan) { scans.push_back(scan); });
  Drive(
      "lidar_front", 40,
      [&](std::span<const uint8_t> packet) {
        node.OnPacket({packet, 0, {}});
      },
      nullptr);
  transport.Drain();
  ASSERT_GE(scans.size(), 2u);
  for (const lidar_scan_t& scan : scans) {
    EXPECT_EQ(scan.time_source, lidar_scan_t::TIME_GNSS);
    EXPECT_GT(scan.utime, Simulator::kFirstUtime);
    EXPECT_LE(scan.utime, Simulator::kFirstUtime + 400'000);
    EXPECT_EQ(scan.num_rings, 32);
  }
  EXPECT_NEAR(static_cast<double>(scans[1].utime - scans[0].utime), 100'000.0, 100.0);
  EXPECT_GT(scans[1].covered_share, 0.99);
  EXPECT_GT(scans[1].num_points, 20'000);
}

}  // namespace
}  // namespace hairpin
