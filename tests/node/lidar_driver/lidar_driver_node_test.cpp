#include "daemons/lidar_driver/lidar_driver_node.hpp"

#include <gtest/gtest.h>

#include "common/lidar_scan.hpp"
#include "tests/support/lidar_setup.hpp"
#include "tests/support/velodyne_packets.hpp"

namespace hairpin {
namespace {

constexpr int64_t kStart = 1'700'000'000'000'000;

LidarDriverNodeParams ShippedParams(const std::string& instance) {
  return LoadLidarDriverParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "lidar_driver",
                                            {"gnss_wait_s=0", instance + ".sensor_address=any"}),
                               instance);
}

/// A sensor, its driver and an IMU whose clock is behind by `clock_error`.
class FrontDriver : public testing::Test {
 protected:
  FrontDriver() {
    listener_.Subscribe(channels::kLidarFront,
                        [this](const lidar_scan_t& scan) { scans_.push_back(scan); });
  }
  void Run(double seconds, int64_t clock_error_us = 0) {
    const int64_t end = now_ + static_cast<int64_t>(seconds * 1e6);
    for (; now_ < end; now_ += 10'000) {
      while (now_ + 10'000 - kStart > source_.time_us)
        node_.OnPacket({Keep(source_.Next()), kStart + source_.time_us, {}});
      imu_t imu{};
      imu.utime = now_ + 10'000 - clock_error_us;
      car_.Publish(channels::kImu, imu);
      transport_.Drain();
    }
  }
  const Bytes& Keep(Bytes packet) { return packet_ = std::move(packet); }
  channel_health_t Health() const {
    for (const auto& health : bus_.Health())
      if (health.channel == "packets") return health;
    return {};
  }

  Transport transport_{"memq://"};
  Bus bus_{transport_, "lidar_driver_front", 1};
  Bus car_{transport_, "can_gateway", 2};
  Bus listener_{transport_, "listener", 3};
  LidarDriverNode node_{ShippedParams("front"), "front", bus_};
  VelodyneSource source_;
  Bytes packet_;
  int64_t now_ = kStart;
  std::vector<lidar_scan_t> scans_;
};

TEST_F(FrontDriver, PublishesARevolutionTenTimesASecond) {
  Run(2.05);
  ASSERT_GE(scans_.size(), 18u);
  std::vector<LidarPoint> points;
  for (const lidar_scan_t& scan : scans_) {
    EXPECT_EQ(UnpackPoints(scan, points), "");
    EXPECT_NEAR(static_cast<double>(points.size()), 57'870, 200);
    EXPECT_EQ(scan.sensor_model, "VLP-32C");
    EXPECT_EQ(scan.time_source, lidar_scan_t::TIME_HOST);
    EXPECT_EQ(scan.num_rings, 32);
  }
  EXPECT_NEAR(static_cast<double>(scans_[9].utime - scans_[8].utime), 100'000, 60);
  EXPECT_EQ(bus_.newest_utime() / 1'000'000, scans_.back().utime / 1'000'000);
}

// FAULTS 1: the other LiDAR's driver is another process, and this one falls silent with its sensor.
TEST_F(FrontDriver, FallsSilentWithItsSensor) {
  Run(1.0);
  const size_t before = scans_.size();
  source_.time_us = 0x7fffffff;  // no packet is due any more
  Run(1.0);
  EXPECT_EQ(scans_.size(), before);
}

// FAULTS 20
TEST_F(FrontDriver, SaysTheErrorOfItsClockAndPublishesNothingBeyondFiftyMilliseconds) {
  Run(3.0, 20'000);
  ASSERT_FALSE(scans_.empty());
  EXPECT_NEAR(scans_.back().clock_error_s, 0.02, 0.0015);
  const size_t before = scans_.size();
  Run(2.0, 80'000);
  const size_t published = scans_.size() - before;
  EXPECT_LE(published, 20u) << "within two seconds";
  Run(1.0, 80'000);
  EXPECT_EQ(scans_.size() - before, published);
  EXPECT_GT(Health().implausible_time, 0);
}

TEST_F(FrontDriver, ReportsWhatItRefused) {
  Run(0.5);
  Bytes packet = source_.Next();
  packet[1205] = 0x21;
  node_.OnPacket({packet, now_, {}});
  node_.OnPacket({packet_, now_, {}});
  EXPECT_EQ(Health().undecodable, 1);
  EXPECT_EQ(Health().duplicates, 1);
  EXPECT_GT(Health().received, 700);
}

TEST(LidarDriverConfig, OfBothInstancesIsGoodAndABadOneIsNamed) {
  EXPECT_EQ(ShippedParams("front").data_port, 2368);
  EXPECT_EQ(ShippedParams("top").data_port, 2369);
  const auto load = [](const std::string& override) {
    LoadLidarDriverParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "lidar_driver", {override}),
                          "front");
  };
  EXPECT_THROW(load("front.model=HDL-64E"), ConfigError);
  EXPECT_THROW(load("top.sensor_address=nowhere"), ConfigError);
  EXPECT_THROW(load("front.max_range_m=500"), ConfigError);
}

}  // namespace
}  // namespace hairpin
