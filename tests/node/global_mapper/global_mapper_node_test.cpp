#include "daemons/global_mapper/global_mapper_node.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "daemons/global_mapper/map_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/global_mapper/lap_world.hpp"

namespace hairpin {
namespace {

local_map_t ToMessage(const LocalMapInput& map) {
  local_map_t message{};
  message.utime = map.utime;
  message.epoch = map.epoch;
  message.map_mode = pipeline_status_t::MODE_FUSION;
  message.x_m = map.T_local_base.x;
  message.y_m = map.T_local_base.y;
  message.yaw_rad = map.T_local_base.yaw;
  for (const LocalMapCone& cone : map.cones) {
    local_cone_t c{};
    c.id = cone.id;
    c.last_seen_utime = map.utime;
    c.x_m = cone.position.x();
    c.y_m = cone.position.y();
    c.covariance_xx_m2 = cone.covariance(0, 0);
    c.covariance_yy_m2 = cone.covariance(1, 1);
    for (size_t i = 0; i < cone.colour.size(); ++i)
      c.probability[i] = static_cast<float>(cone.colour[i]);
    c.existence = static_cast<float>(cone.existence);
    c.num_observations = cone.num_observations;
    message.cones.push_back(c);
  }
  message.num_cones = static_cast<int32_t>(message.cones.size());
  return message;
}

class GlobalMapperNodeTest : public ::testing::Test {
 protected:
  GlobalMapperNodeTest()
      : transport_("memq://"), world_({0.003, 0.0001}), sender_(transport_, "test", 1) {
    config_.store.directory = folder_.path();
    sender_.Subscribe(channels::kGlobalMap, [this](const global_map_t& m) { maps_.push_back(m); });
    Start();
  }

  void Start() {
    bus_ = std::make_unique<Bus>(transport_, "global_mapper", ++boots_);
    node_ = std::make_unique<GlobalMapperNode>(config_, *bus_);
  }
  /// As kill -9 leaves it: nothing is written on the way out.
  void Kill() {
    node_.reset();
    bus_.reset();
  }

  void DriveTo(double distance) {
    // The first one where the car stands, which makes the map's frame the world's.
    double step = world_.driven() == 0.0 ? 0.0 : 0.5;
    while (world_.driven() < distance) {
      sender_.Publish(channels::kLocalMap, ToMessage(world_.Drive(step)));
      transport_.Drain();
      step = 0.5;
    }
  }

  const TemporaryFolder folder_;
  Transport transport_;
  LapWorld world_;
  GlobalMapperConfig config_ = ShippedConfig();
  Bus sender_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<GlobalMapperNode> node_;
  std::vector<global_map_t> maps_;
  int64_t boots_ = 10;
};

TEST_F(GlobalMapperNodeTest, AnswersEachLocalMapWithItsUtime) {
  DriveTo(20.0);
  ASSERT_EQ(maps_.size(), 41u);
  EXPECT_EQ(maps_.back().utime, world_.utime());
  EXPECT_EQ(maps_.back().phase, global_map_t::PHASE_MAPPING);
  EXPECT_TRUE(maps_.back().valid);
  EXPECT_GT(maps_.back().num_cones, 4);
  const Pose2 T_map_local{maps_.back().T_map_local[0], maps_.back().T_map_local[1],
                          maps_.back().T_map_local[2]};
  EXPECT_NEAR(T_map_local.x, 0.0, 0.5);
}

TEST_F(GlobalMapperNodeTest, RefusesAMapWithACovarianceThatCannotBeAndGoesOn) {
  DriveTo(10.0);
  const size_t answered = maps_.size();
  local_map_t bad = ToMessage(world_.Drive(0.5));
  ASSERT_FALSE(bad.cones.empty());
  bad.cones[0].covariance_xx_m2 = -1.0;
  sender_.Publish(channels::kLocalMap, bad);
  transport_.Drain();
  EXPECT_EQ(maps_.size(), answered);
  DriveTo(12.0);
  EXPECT_GT(maps_.size(), answered);
}

TEST_F(GlobalMapperNodeTest, WritesTheFinishedMapWhenTheLoopIsClosed) {
  DriveTo(120.0);
  EXPECT_FALSE(std::filesystem::exists(folder_.File("map.yaml")));
  DriveTo(LapWorld::kLap + 20.0);
  const MapFile map = LoadMapFile(folder_.File("map.yaml"));
  EXPECT_EQ(map.session, 11);
  EXPECT_EQ(map.laps, 1);
  EXPECT_TRUE(map.gate);
  EXPECT_GT(map.cones.size(), 50u);
}

// FAULTS row 41.
TEST_F(GlobalMapperNodeTest, KilledAtAnyMomentGoesOnWithEveryLandmark) {
  GlobalMapper undisturbed(config_.params);
  LapWorld same({0.003, 0.0001});
  GlobalMapEstimate expected = *undisturbed.AddLocalMap(same.Drive(0.0)).estimate;
  while (same.driven() < LapWorld::kLap + 20.0)
    expected = *undisturbed.AddLocalMap(same.Drive(0.5)).estimate;
  for (int i = 1; i <= 20; ++i) {
    DriveTo(LapWorld::kLap * i / 20.0 + 1.7 * std::sin(i));
    const auto cones = maps_.back().num_cones;
    Kill();
    Start();
    DriveTo(world_.driven() + 0.5);
    EXPECT_GE(maps_.back().num_cones, cones) << "kill " << i;
  }
  DriveTo(LapWorld::kLap + 20.0);
  EXPECT_EQ(maps_.back().phase, global_map_t::PHASE_LOOP_CLOSED);
  ASSERT_EQ(static_cast<size_t>(maps_.back().num_cones), expected.cones.size());
  for (size_t i = 0; i < expected.cones.size(); ++i) {
    EXPECT_NEAR(maps_.back().cones[i].x_m, expected.cones[i].position.x(), 0.02);
    EXPECT_NEAR(maps_.back().cones[i].y_m, expected.cones[i].position.y(), 0.02);
  }
}

TEST_F(GlobalMapperNodeTest, KilledInAKnownMapGoesOnWhereTheCarIs) {
  DriveTo(LapWorld::kLap + 20.0);
  Kill();
  config_.known_map = LoadMapFile(folder_.File("map.yaml"));
  world_ = LapWorld({0.003, 0.0001});
  Start();
  maps_.clear();
  for (int i = 0; i < 10; ++i) {
    sender_.Publish(channels::kLocalMap, ToMessage(world_.Drive(0.0)));
    transport_.Drain();
  }
  DriveTo(LapWorld::kLap + 60.0);
  ASSERT_EQ(maps_.back().phase, global_map_t::PHASE_LOCALISED);
  ASSERT_EQ(maps_.back().laps, 1);
  Kill();
  world_.Drive(10.0);
  Start();
  DriveTo(world_.driven() + 0.5);
  EXPECT_EQ(maps_.back().phase, global_map_t::PHASE_LOCALISED);
  EXPECT_EQ(maps_.back().laps, 1);
  const Eigen::Vector2d is(maps_.back().x_m, maps_.back().y_m);
  EXPECT_LT((is - world_.T_map_base().position()).norm(), 0.5);
  DriveTo(2.0 * LapWorld::kLap + 10.0);
  EXPECT_EQ(maps_.back().laps, 2);
}

// As systemd starts it, from the files as they are shipped.
TEST(GlobalMapperFiles, LieInTheStateDirectoryAndTheMapOfTheLastDriveIsKnown) {
  const TemporaryFolder folder;
  unsetenv("STATE_DIRECTORY");
  EXPECT_EQ(ShippedConfig().store.directory, "");
  EXPECT_FALSE(ShippedConfig().known_map);
  setenv("STATE_DIRECTORY", (folder.path() + ":/elsewhere").c_str(), 1);
  EXPECT_EQ(ShippedConfig().store.directory, folder.path());
  EXPECT_FALSE(ShippedConfig().known_map);
  MapFile map;
  map.cones.push_back({1, {3.0, 1.0}, 0.01 * Eigen::Matrix2d::Identity(), kColourUnknown, 5});
  SaveMapFile(map, folder.File("map.yaml"));
  ASSERT_TRUE(ShippedConfig().known_map);
  EXPECT_EQ(ShippedConfig().known_map->cones.size(), 1u);
  std::ofstream(folder.File("map.yaml")) << "no map";
  EXPECT_FALSE(ShippedConfig().known_map);
  unsetenv("STATE_DIRECTORY");
}

TEST_F(GlobalMapperNodeTest, DoesNotTakeTheJournalOfAnotherDrive) {
  DriveTo(40.0);
  Kill();
  world_ = LapWorld({0.003, 0.0001});  // an hour earlier, or later: not within 10 s
  Start();
  maps_.clear();
  DriveTo(1.0);
  EXPECT_EQ(maps_.back().num_cones, 0);
}

// FAULTS row 27: a disk that cannot be written to costs the journal and nothing else.
TEST_F(GlobalMapperNodeTest, MapsOnWhereTheFolderCannotBeMade) {
  Kill();
  config_.store.directory = "/proc/nowhere";
  Start();
  DriveTo(20.0);
  EXPECT_EQ(maps_.size(), 41u);
}

}  // namespace
}  // namespace hairpin
