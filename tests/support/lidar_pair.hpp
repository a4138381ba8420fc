#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/channels.hpp"
#include "daemons/lidar_cone_detector/lidar_cone_detector_node.hpp"
#include "daemons/lidar_driver/lidar_driver_node.hpp"
#include "tests/support/lidar_packets.hpp"

namespace hairpin {

/// Both LiDARs of a parked car in a small world, on the wire: their packets, as a test lets them
/// through, reach the two drivers, and these the detector, all on memq.
class LidarPair {
 public:
  static constexpr int64_t kStart = 1'700'000'000'000'000;
  enum Lidar : size_t { kFront, kTop };

  /// What a test does to a data packet before the driver gets it; false loses it.
  using Meddler = std::function<bool(VelodyneDataPacket&)>;

  explicit LidarPair(const LidarWorld& world, const std::vector<std::string>& driver_overrides = {})
      : units_{Unit{*this, "front", driver_overrides, world},
               Unit{*this, "top", driver_overrides, world}} {
    observer_.Subscribe(channels::kConesLidar, [this](const cones_t& m) { cones_.push_back(m); });
    observer_.Subscribe(channels::kLidarFront,
                        [this](const lidar_scan_t& m) { Keep(units_[kFront], m); });
    observer_.Subscribe(channels::kLidarTop,
                        [this](const lidar_scan_t& m) { Keep(units_[kTop], m); });
  }

  /// Goes on by so long, in steps of 10 ms.
  void Run(double seconds) {
    const int64_t end = now_ + static_cast<int64_t>(seconds * 1e6);
    while (now_ < end) {
      now_ += 10'000;
      for (Unit& unit : units_) Send(unit);
      Publish();
    }
  }

  void Meddle(Lidar lidar, Meddler meddler) { units_[lidar].meddler = std::move(meddler); }
  /// The sensor's clock is ahead by so much from now on.
  void SetClockError(Lidar lidar, int64_t us) { units_[lidar].clock_error_us = us; }
  /// Whether its GPS receiver has a fix.
  void SetGps(Lidar lidar, bool on) { units_[lidar].gps = on; }

  int64_t now() const { return now_; }
  /// All since the start, without their points.
  const std::vector<lidar_scan_t>& scans(Lidar lidar) const { return units_[lidar].scans; }
  const std::vector<cones_t>& cones() const { return cones_; }
  channel_health_t Health(Lidar lidar) const {
    for (const channel_health_t& health : units_[lidar].bus->Health())
      if (health.channel == "packets") return health;
    return {};
  }

 private:
  struct Unit {
    Unit(LidarPair& pair, const std::string& name, std::vector<std::string> overrides,
         const LidarWorld& world) {
      overrides.push_back(name + ".sensor_address=any");
      const LidarDriverNodeParams params = LoadLidarDriverParams(
          Config::Load(HAIRPIN_SOURCE_DIR "/config", "lidar_driver", overrides), name);
      const size_t number = name == "front" ? kFront : kTop;
      turn = TurnPackets(world, pair.detector_params_.T_base_sensor[number],
                         params.driver.revolution.cut_azimuth, 0.0, 0.01f, kStart);
      bus = std::make_unique<Bus>(pair.transport_, "lidar_driver_" + name,
                                  static_cast<int64_t>(number) + 10);
      node = std::make_unique<LidarDriverNode>(params, name, *bus);
    }

    std::vector<VelodyneDataPacket> turn;
    std::unique_ptr<Bus> bus;
    std::unique_ptr<LidarDriverNode> node;
    Meddler meddler;
    int64_t sent = 0;  // data packets
    int64_t next_position_utime = kStart;
    int64_t clock_error_us = 0;
    bool gps = true;
    std::vector<lidar_scan_t> scans;
  };

  static void Keep(Unit& unit, lidar_scan_t scan) {
    scan.points.clear();
    unit.scans.push_back(std::move(scan));
  }

  // What the sensor has fired until now.
  void Send(Unit& unit) {
    const int64_t packet_ns = 12 * Vlp32c().sequence_ns;
    for (; kStart + (unit.sent + 1) * packet_ns / 1000 <= now_; ++unit.sent) {
      VelodyneDataPacket packet = unit.turn[static_cast<size_t>(unit.sent % kTurnPackets)];
      const int64_t stamp = kStart + unit.sent * packet_ns / 1000 + unit.clock_error_us;
      for (size_t byte = 0; byte < 4; ++byte)
        packet[1200 + byte] = static_cast<uint8_t>(stamp % 3'600'000'000 >> (8 * byte));
      if (!unit.meddler || unit.meddler(packet)) unit.node->OnPacket({packet, now_, {}});
    }
    if (now_ < unit.next_position_utime || !unit.gps) return;
    unit.next_position_utime = now_ + 500'000;
    unit.node->OnPacket({EncodeVelodynePosition(now_ + unit.clock_error_us), now_, {}});
  }

  void Publish() {
    imu_t imu{};
    imu.utime = now_;
    car_.Publish(channels::kImu, imu);
    velocity_t velocity{};
    velocity.utime = now_;
    velocity.valid = 1;
    car_.Publish(channels::kVelocity, velocity);
    transport_.Drain();
  }

  LidarConeDetectorNodeParams detector_params_ = LoadLidarConeDetectorParams(
      Config::Load(HAIRPIN_SOURCE_DIR "/config", "lidar_cone_detector"));
  Transport transport_{"memq://"};
  Bus car_{transport_, "car", 1};
  Bus observer_{transport_, "observer", 2};
  Bus detector_bus_{transport_, "lidar_cone_detector", 3};
  LidarConeDetectorNode detector_{detector_params_, detector_bus_};
  std::array<Unit, kNumLidars> units_;
  std::vector<cones_t> cones_;
  int64_t now_ = kStart;
};

}  // namespace hairpin
