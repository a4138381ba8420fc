#include "daemons/local_mapper/local_mapper_node.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "common/channels.hpp"
#include "common/cone.hpp"
#include "tests/support/lane_world.hpp"

namespace hairpin {
namespace {

constexpr int64_t kStart = 1'000'000;
constexpr int64_t kCycle = 100'000;
constexpr int64_t kTick = 10'000;

LocalMapperParams Shipped() {
  return LoadLocalMapperParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "local_mapper"));
}

class LocalMapperNodeTest : public testing::Test {
 protected:
  LocalMapperNodeTest() : transport_("memq://"), tester_(transport_, "tester", 1) {
    tester_.Subscribe(channels::kLocalMap,
                      [this](const local_map_t& map) { maps_.push_back(map); });
    Start(2);
  }

  void Start(int64_t boot_id) {
    node_.reset();
    bus_ = std::make_unique<Bus>(transport_, "local_mapper", boot_id);
    node_ = std::make_unique<LocalMapperNode>(Shipped(), *bus_);
  }

  template <class M>
  void Send(const Channel<M>& channel, const M& message) {
    tester_.Publish(channel, message);
    transport_.Drain();
  }
  void SendMode(int64_t utime, int32_t mode) {
    pipeline_status_t status{};
    status.utime = utime;
    status.map_mode = mode;
    Send(channels::kPipelineStatus, status);
  }
  void SendVelocity(int64_t utime, double speed, bool valid = true) {
    velocity_t velocity{};
    velocity.utime = utime;
    velocity.valid = valid;
    velocity.vx_mps = speed;
    Send(channels::kVelocity, velocity);
  }
  void Drive(int64_t from, int64_t until) {
    for (int64_t utime = from; utime <= until; utime += kTick) SendVelocity(utime, 10.0);
  }
  static cones_t Cones(int64_t utime, std::vector<Eigen::Vector2d> positions) {
    cones_t message{};
    message.utime = utime;
    message.sectors = {{-1.75f, 1.75f, 22.0f}};
    message.num_sectors = 1;
    for (const Eigen::Vector2d& position : positions) {
      message.cones.push_back(ToMessage(ConeObservation{
          position, 0.0025 * Eigen::Matrix2d::Identity(), {0.1, 0.9, 0.0, 0.0, 0.0}}));
    }
    message.num_cones = static_cast<int32_t>(message.cones.size());
    return message;
  }
  /// Ready to use sets of fusion from kStart to kStart + 1 s.
  void Ready() {
    SendMode(kStart, pipeline_status_t::MODE_FUSION);
    Drive(kStart, kStart + 10 * kCycle);
  }
  channel_health_t Health(const std::string& channel) const {
    for (const channel_health_t& health : bus_->Health()) {
      if (health.channel == channel) return health;
    }
    ADD_FAILURE() << channel << " is not subscribed";
    return {};
  }

  Transport transport_;
  Bus tester_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<LocalMapperNode> node_;
  std::vector<local_map_t> maps_;
};

TEST_F(LocalMapperNodeTest, AnswersEachUsedSetWithOneMapOfItsTime) {
  Ready();
  Send(channels::kConesFusion, Cones(kStart + 8 * kCycle, {{5.0, 1.5}}));
  Send(channels::kConesFusion, Cones(kStart + 9 * kCycle, {{4.0, 1.5}}));
  ASSERT_EQ(maps_.size(), 2u);
  const local_map_t& map = maps_.back();
  EXPECT_EQ(map.utime, kStart + 9 * kCycle);
  EXPECT_EQ(map.epoch, kStart + 8 * kCycle);
  EXPECT_EQ(map.map_mode, pipeline_status_t::MODE_FUSION);
  EXPECT_NEAR(map.x_m, 9.0, 1e-9);
  ASSERT_EQ(map.num_cones, 1);
  EXPECT_NEAR(map.cones[0].x_m, 13.0, 1e-9);
  EXPECT_EQ(map.cones[0].num_observations, 2);
  EXPECT_EQ(map.cones[0].last_seen_utime, map.utime);
  EXPECT_GT(map.cones[0].existence, 0.9f);
  EXPECT_GT(map.cones[0].probability[cone_observation_t::BLUE], 0.9f);
}

TEST_F(LocalMapperNodeTest, IsSilentBeforeAnyStatus) {
  Drive(kStart, kStart + 5 * kCycle);
  Send(channels::kConesFusion, Cones(kStart + kCycle, {{5.0, 1.5}}));
  EXPECT_TRUE(maps_.empty());
  EXPECT_EQ(Health("CONES_FUSION").refused, 0);
}

TEST_F(LocalMapperNodeTest, DoesNotPublishOldConesWhenAPipelineDies) {
  Ready();
  Send(channels::kConesFusion, Cones(kStart + kCycle, {{5.0, 1.5}}));
  SendMode(kStart + 10 * kCycle, pipeline_status_t::MODE_NONE);
  Drive(kStart + 10 * kCycle + kTick, kStart + 20 * kCycle);
  EXPECT_EQ(maps_.size(), 1u);
}

TEST_F(LocalMapperNodeTest, RefusesAndCountsWhatCannotBe) {
  Ready();
  std::vector<cones_t> bad(8, Cones(kStart + kCycle, {{5.0, 1.5}, {6.0, -1.5}}));
  bad[0].cones[1].covariance_xx_m2 = -1.0;
  bad[1].cones[1].covariance_xy_m2 = 1.0;  // not positive definite
  bad[2].cones[1].x_m = 500.0;
  bad[3].cones[1].probability[0] = 7.0f;
  bad[4].sectors[0].min_bearing_rad = 2.0f;  // beyond its maximum
  bad[5].sectors[0].max_range_m = -1.0f;
  bad[6].sectors.assign(17, bad[6].sectors[0]);
  bad[6].num_sectors = 17;
  bad[7].cones.assign(201, bad[7].cones[0]);
  bad[7].num_cones = 201;
  for (const cones_t& message : bad) Send(channels::kConesFusion, message);
  EXPECT_TRUE(maps_.empty());
  EXPECT_EQ(Health("CONES_FUSION").refused, 8);
  Send(channels::kConesFusion, Cones(kStart + kCycle, {{5.0, 1.5}}));
  EXPECT_EQ(maps_.size(), 1u);
}

TEST_F(LocalMapperNodeTest, IsNotPoisonedByNaN) {
  Ready();
  cones_t message = Cones(kStart + kCycle, {{5.0, 1.5}});
  message.cones[0].x_m = std::numeric_limits<double>::quiet_NaN();
  Send(channels::kConesFusion, message);
  SendVelocity(kStart + 11 * kCycle, std::numeric_limits<double>::infinity());
  EXPECT_EQ(Health("CONES_FUSION").undecodable, 1);
  EXPECT_EQ(Health("VELOCITY").undecodable, 1);
  Send(channels::kConesFusion, Cones(kStart + 2 * kCycle, {{5.0, 1.5}}));
  ASSERT_EQ(maps_.size(), 1u);
  EXPECT_EQ(maps_[0].num_cones, 1);
}

TEST_F(LocalMapperNodeTest, RefusesTimeGoingBackAndStatusesThatCannotBe) {
  Ready();
  SendVelocity(kStart + 5 * kCycle, 10.0);
  SendVelocity(kStart + 10 * kCycle + kTick, 1000.0);
  EXPECT_EQ(Health("VELOCITY").refused, 2);
  SendMode(kStart - kTick, pipeline_status_t::MODE_NONE);
  SendMode(kStart + kCycle, 17);
  SendMode(kStart + kCycle, pipeline_status_t::MODE_UNKNOWN);
  EXPECT_EQ(Health("PIPELINE_STATUS").refused, 3);
  Send(channels::kConesFusion, Cones(kStart + 9 * kCycle, {{5.0, 1.5}}));
  EXPECT_EQ(maps_.size(), 1u);
}

TEST_F(LocalMapperNodeTest, UsesLateSetsWithinTheHistoryAndRefusesLaterOnes) {
  SendMode(kStart, pipeline_status_t::MODE_FUSION);
  Drive(kStart, kStart + 20 * kCycle);
  Send(channels::kConesFusion, Cones(kStart + 19 * kCycle, {{5.0, 1.5}}));
  Send(channels::kConesFusion, Cones(kStart + 15 * kCycle, {{9.0, 1.5}}));
  Send(channels::kConesFusion, Cones(kStart + 5 * kCycle, {{19.0, 1.5}}));
  ASSERT_EQ(maps_.size(), 2u);
  EXPECT_EQ(maps_[1].utime, kStart + 15 * kCycle);
  EXPECT_EQ(maps_[1].num_cones, 1);
  EXPECT_EQ(Health("CONES_FUSION").refused, 1);
}

TEST_F(LocalMapperNodeTest, WaitsForFreshVelocitiesAfterInvalidOnes) {
  Ready();
  for (int64_t t = kTick; t <= 2 * kCycle; t += kTick)
    SendVelocity(kStart + 10 * kCycle + t, 10.0, false);
  Send(channels::kConesFusion, Cones(kStart + 12 * kCycle, {{5.0, 1.5}}));
  EXPECT_TRUE(maps_.empty());
  EXPECT_EQ(Health("CONES_FUSION").refused, 1);
  Drive(kStart + 12 * kCycle + kTick, kStart + 14 * kCycle);
  Send(channels::kConesFusion, Cones(kStart + 13 * kCycle, {{5.0, 1.5}}));
  EXPECT_EQ(maps_.size(), 1u);
}

TEST_F(LocalMapperNodeTest, StartsEmptyWithANewEpochAfterARestart) {
  Ready();
  for (int i = 5; i < 8; ++i)
    Send(channels::kConesFusion, Cones(kStart + i * kCycle, {{12.0 - i, 1.5}, {12.0 - i, -1.5}}));
  ASSERT_EQ(maps_.back().num_cones, 2);
  const int64_t old_epoch = maps_.back().epoch;
  maps_.clear();
  Start(3);
  Send(channels::kConesFusion, Cones(kStart + 10 * kCycle, {{5.0, 1.5}}));
  EXPECT_TRUE(maps_.empty()) << "without mode and velocity";
  SendMode(kStart + 10 * kCycle, pipeline_status_t::MODE_FUSION);
  Drive(kStart + 11 * kCycle, kStart + 12 * kCycle);
  Send(channels::kConesFusion, Cones(kStart + 12 * kCycle, {{5.0, 1.5}}));
  ASSERT_EQ(maps_.size(), 1u);
  EXPECT_GT(maps_[0].epoch, old_epoch);
  EXPECT_EQ(maps_[0].num_cones, 1);
  EXPECT_EQ(maps_[0].cones[0].num_observations, 1);
}

/// LOCAL_MAP as encoded, over ten seconds of a lane.
std::vector<uint8_t> RecordLane() {
  Transport transport("memq://");
  Bus mapper_bus(transport, "local_mapper", 2);
  Bus sensors(transport, "sensors", 1);
  LocalMapperNode node(Shipped(), mapper_bus);
  std::vector<uint8_t> bytes;
  const auto recorder =
      transport.Subscribe("LOCAL_MAP", [&](const std::string&, const uint8_t* data, size_t size) {
        bytes.insert(bytes.end(), data, data + size);
      });
  test::LaneWorld world({.seed = 5, .length = 60.0});
  pipeline_status_t status{};
  status.utime = world.utime();
  status.map_mode = pipeline_status_t::MODE_LIDAR_AND_CAMERA;
  sensors.Publish(channels::kPipelineStatus, status);
  while (world.Step()) {
    velocity_t velocity{};
    velocity.utime = world.utime();
    velocity.valid = true;
    velocity.vx_mps = world.velocity().vx;
    velocity.vy_mps = world.velocity().vy;
    velocity.yaw_rate_radps = world.velocity().yaw_rate;
    sensors.Publish(channels::kVelocity, velocity);
    for (const auto& scan : world.TakeScans()) {
      if (scan.pipeline == Pipeline::kLidar) sensors.Publish(channels::kConesLidar, scan.message);
      if (scan.pipeline == Pipeline::kCamera) sensors.Publish(channels::kConesCamera, scan.message);
    }
    transport.Drain();
  }
  return bytes;
}

TEST(LocalMapperReplay, GivesTheSameBytesForTheSameMessages) {
  const std::vector<uint8_t> first = RecordLane();
  EXPECT_GT(first.size(), 10'000u);
  EXPECT_EQ(first, RecordLane());
}

}  // namespace
}  // namespace hairpin
