#include "daemons/lidar_cone_detector/lidar_cone_detector_node.hpp"

#include <gmock/gmock.h>

#include "common/channels.hpp"
#include "tests/support/lidar_world.hpp"

namespace hairpin {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr int64_t kStart = 1'700'000'000'000'000;

LidarConeDetectorNodeParams Params() {
  return LoadLidarConeDetectorParams(
      Config::Load(HAIRPIN_SOURCE_DIR "/config", "lidar_cone_detector"));
}

class LidarConeDetectorNodeTest : public testing::Test {
 protected:
  LidarConeDetectorNodeTest() {
    world_.cones = {{{5.0f, 1.5f}}, {{5.0f, -1.5f}}, {{9.0f, 2.0f}}};
    observer_.Subscribe(channels::kConesLidar, [this](const cones_t& m) { cones_.push_back(m); });
    observer_.Subscribe(channels::kConeClusters,
                        [this](const cone_clusters_t& m) { clusters_.push_back(m); });
    for (int i = 0; i <= 12; ++i) Velocity(kStart - 120'000 + i * 10'000);
  }

  void Velocity(int64_t utime) {
    velocity_t message{};
    message.utime = utime;
    message.valid = 1;
    sender_.Publish(channels::kVelocity, message);
    transport_.Drain();
  }

  lidar_scan_t Message(size_t lidar, int64_t utime) const {
    SensorGeometry sensor = UnevenSensor({0.0f, 0.0f, 0.0f}, 0.4f);
    sensor.T_base_sensor = params_.T_base_sensor[lidar];
    const LabelledCloud scan = Scan(world_, sensor, 0.01f, 40.0f, 1);
    const Eigen::Isometry3f T_sensor_base = sensor.T_base_sensor.inverse();
    std::vector<LidarPoint> points;
    for (size_t i = 0; i < scan.cloud.size(); ++i) {
      points.push_back(
          {T_sensor_base * Eigen::Vector3f(scan.cloud.x[i], scan.cloud.y[i], scan.cloud.z[i]),
           scan.cloud.intensity[i], scan.cloud.ring[i], 0.0f});
    }
    lidar_scan_t message{};
    message.utime = utime;
    message.sensor_model = "test";
    message.covered_share = 1.0;
    message.ring_elevation_rad = sensor.ring_elevation;
    message.num_rings = static_cast<int32_t>(sensor.ring_elevation.size());
    message.azimuth_step_rad = static_cast<double>(sensor.azimuth_step);
    message.coordinate_step_m = 0.002;
    message.time_step_s = 2e-6;
    PackPoints(points, message);
    return message;
  }

  void Front(int64_t utime) {
    sender_.Publish(channels::kLidarFront, Message(0, utime));
    transport_.Drain();
  }
  void Top(int64_t utime) {
    sender_.Publish(channels::kLidarTop, Message(1, utime));
    transport_.Drain();
  }

  LidarConeDetectorNodeParams params_ = Params();
  LidarWorld world_;
  Transport transport_{"memq://"};
  Bus sender_{transport_, "sender", 1};
  Bus observer_{transport_, "observer", 2};
  Bus bus_{transport_, "lidar_cone_detector", 3};
  LidarConeDetectorNode node_{params_, bus_};
  std::vector<cones_t> cones_;
  std::vector<cone_clusters_t> clusters_;
};

TEST_F(LidarConeDetectorNodeTest, AnswersAPairOfScansOnceWithItsNewestTime) {
  Front(kStart);
  EXPECT_THAT(cones_, SizeIs(1)) << "nothing was ever heard of the other sensor";
  Top(kStart + 20'000);
  EXPECT_THAT(cones_, SizeIs(1)) << "the front's scan of this revolution may still come";
  Velocity(kStart + 80'000);
  EXPECT_THAT(cones_, SizeIs(2)) << "it did not";
  Front(kStart + 100'000);
  Top(kStart + 120'000);
  ASSERT_THAT(cones_, SizeIs(3));
  EXPECT_EQ(cones_.back().utime, kStart + 120'000);
  EXPECT_THAT(cones_.back().cones, SizeIs(3));
}

TEST_F(LidarConeDetectorNodeTest, ClustersAreTheConesWithTheirReturns) {
  Front(kStart);
  ASSERT_THAT(cones_, SizeIs(1));
  ASSERT_THAT(clusters_, SizeIs(1));
  EXPECT_EQ(clusters_[0].utime, cones_[0].utime);
  ASSERT_EQ(clusters_[0].clusters.size(), cones_[0].cones.size());
  ASSERT_THAT(cones_[0].cones, SizeIs(3));
  for (size_t i = 0; i < cones_[0].cones.size(); ++i) {
    const cone_cluster_t& cluster = clusters_[0].clusters[i];
    EXPECT_EQ(cluster.cone.x_m, cones_[0].cones[i].x_m);
    EXPECT_GE(cluster.num_points, 3);
    for (int k = 0; k < cluster.num_points; ++k) {
      const auto j = static_cast<size_t>(k);
      EXPECT_NEAR(static_cast<double>(cluster.x_m[j]), cluster.cone.x_m, 0.25);
      EXPECT_NEAR(static_cast<double>(cluster.y_m[j]), cluster.cone.y_m, 0.25);
      EXPECT_LT(cluster.z_m[j], 0.36f);
    }
  }
}

TEST_F(LidarConeDetectorNodeTest, SectorsSayWhereHasBeenLooked) {
  Front(kStart);
  ASSERT_THAT(cones_, SizeIs(1));
  ASSERT_THAT(cones_[0].sectors, Not(IsEmpty()));
  const view_sector_t& sector = cones_[0].sectors[0];
  EXPECT_LT(sector.min_bearing_rad, -1.0f);
  EXPECT_GT(sector.max_bearing_rad, 1.0f);
}

TEST_F(LidarConeDetectorNodeTest, GoesOnWithTheOtherSensorWhenOneIsDead) {
  Front(kStart);
  for (int i = 1; i <= 5; ++i) {
    for (int k = 1; k <= 10; ++k) Velocity(kStart + (i - 1) * 100'000 + k * 10'000 + 1'000);
    Top(kStart + i * 100'000);
  }
  Velocity(kStart + 570'000);
  ASSERT_THAT(cones_, SizeIs(6));
  for (const cones_t& message : cones_) EXPECT_THAT(message.cones, SizeIs(3));
}

TEST_F(LidarConeDetectorNodeTest, RefusesAScanWithAHoleAndOneWithoutVelocity) {
  lidar_scan_t message = Message(0, kStart);
  message.points[100] ^= 1;
  sender_.Publish(channels::kLidarFront, message);
  transport_.Drain();
  Front(kStart + 1'000'000);
  EXPECT_THAT(cones_, IsEmpty());
  for (const channel_health_t& health : bus_.Health()) {
    if (health.channel != channels::kLidarFront.name) continue;
    EXPECT_EQ(health.refused, 2);
  }
}

TEST_F(LidarConeDetectorNodeTest, IgnoresAnAbsurdVelocity) {
  velocity_t message{};
  message.utime = kStart + 5'000;
  message.valid = 1;
  message.vx_mps = 1000.0;
  sender_.Publish(channels::kVelocity, message);
  transport_.Drain();
  Front(kStart);
  ASSERT_THAT(cones_, SizeIs(1));
  EXPECT_THAT(cones_[0].cones, SizeIs(3));
}

}  // namespace
}  // namespace hairpin
