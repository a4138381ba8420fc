#include "daemons/global_mapper/global_mapper.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/unit/global_mapper/lap_world.hpp"

namespace hairpin {
namespace {

constexpr double kStep = 0.5;  // m between local maps

/// Feeds local maps until the car has driven `distance`; the first one where it stands, which makes
/// the map's frame the world's.
GlobalMapEstimate DriveTo(double distance, LapWorld& world, GlobalMapper& mapper,
                          std::vector<MapRecord>* records = nullptr) {
  GlobalMapEstimate last;
  double step = world.driven() == 0.0 ? 0.0 : kStep;
  while (world.driven() < distance) {
    GlobalMapper::Outcome outcome = mapper.AddLocalMap(world.Drive(step));
    step = kStep;
    EXPECT_TRUE(outcome.refused.empty()) << outcome.refused;
    if (outcome.estimate) last = *outcome.estimate;
    if (records != nullptr)
      records->insert(records->end(), outcome.records.begin(), outcome.records.end());
  }
  return last;
}

TEST(GlobalMapper, ClosesTheLoopAndMapsEveryConeOnce) {
  LapWorld world({0.003, 0.0001});
  GlobalMapper mapper(ShippedConfig().params);
  const GlobalMapEstimate before = DriveTo(120.0, world, mapper);
  EXPECT_EQ(before.phase, MapPhase::kMapping);
  const GlobalMapEstimate after = DriveTo(LapWorld::kLap + 15.0, world, mapper);
  EXPECT_EQ(after.phase, MapPhase::kLoopClosed);
  EXPECT_EQ(after.laps, 1);
  EXPECT_EQ(after.cones.size(), world.cones().size());
  EXPECT_LT(WorstError(after, world), 0.6);
}

// A car with poor odometry that knows it: what its covariance calls impossible is no loop.
TEST(GlobalMapper, ClosesTheLoopWhereTheDriftExceedsTheConeSpacing) {
  LapWorld world({0.08, 0.003});
  GlobalMapperParams params = ShippedConfig().params;
  params.odometry.position_sigma = 0.04;
  params.odometry.yaw_sigma = 0.003;
  GlobalMapper mapper(params);
  const GlobalMapEstimate before = DriveTo(LapWorld::kLap - 15.0, world, mapper);
  ASSERT_EQ(before.phase, MapPhase::kMapping);
  EXPECT_GT((before.T_map_base.position() - world.T_map_base().position()).norm(), 4.5);
  const GlobalMapEstimate after = DriveTo(LapWorld::kLap + 20.0, world, mapper);
  EXPECT_EQ(after.phase, MapPhase::kLoopClosed);
  EXPECT_EQ(after.cones.size(), world.cones().size());
  EXPECT_LT((after.T_map_base.position() - world.T_map_base().position()).norm(), 0.5);
}

// A car that does not know how poor its odometry is: the shape alone must say it.
TEST(GlobalMapper, ClosesTheLoopByShapeWhereTheDriftIsBeyondItsCovariance) {
  LapWorld world({0.05, 0.002});
  GlobalMapper mapper(ShippedConfig().params);
  const GlobalMapEstimate before = DriveTo(LapWorld::kLap - 15.0, world, mapper);
  ASSERT_EQ(before.phase, MapPhase::kMapping);
  EXPECT_GT((before.T_map_base.position() - world.T_map_base().position()).norm(), 4.5);
  const GlobalMapEstimate after = DriveTo(LapWorld::kLap + 30.0, world, mapper);
  EXPECT_EQ(after.phase, MapPhase::kLoopClosed);
  EXPECT_EQ(after.cones.size(), world.cones().size());
  EXPECT_LT((after.T_map_base.position() - world.T_map_base().position()).norm(), 1.0);
}

// Nothing was heard for 0.8 s in a bend: neither where the car was nor how it turned.
TEST(GlobalMapper, BridgesAGapOfTheOdometryByTheShapeOfTheCones) {
  LapWorld world({0.002, 0.0});
  GlobalMapper mapper(ShippedConfig().params);
  std::vector<MapRecord> records;
  const Pose2 before = DriveTo(60.0, world, mapper, &records).T_map_base;
  const Eigen::Matrix3d covariance = 1e-4 * Eigen::Matrix3d::Identity();
  mapper.AddVelocity(world.utime(), {LapWorld::kSpeed, 0.0, 0.0}, covariance);
  world.Drive(8.0);
  mapper.AddVelocity(world.utime(), {LapWorld::kSpeed, 0.0, 0.0}, covariance);
  world.Restart();
  const Pose2 by_velocity = before * Pose2{8.0, 0.0, 0.0};
  EXPECT_GT((by_velocity.position() - world.T_map_base().position()).norm(), 0.6);
  const GlobalMapper::Outcome first = mapper.AddLocalMap(world.Drive(0.0));
  records.insert(records.end(), first.records.begin(), first.records.end());
  const GlobalMapEstimate after = DriveTo(80.0, world, mapper, &records);
  EXPECT_LT((after.T_map_base.position() - world.T_map_base().position()).norm(), 0.5);
  EXPECT_LT(WorstError(after, world), 0.5);
  const bool bridged = std::any_of(records.begin(), records.end(), [](const MapRecord& record) {
    const auto* merge = std::get_if<MergeRecord>(&record);
    return merge != nullptr && merge->by_shape && !merge->loop;
  });
  EXPECT_TRUE(bridged);
}

TEST(GlobalMapper, DoesNotCloseALoopWhereOtherConesStand) {
  LapWorld world({0.003, 0.0001});
  GlobalMapper mapper(ShippedConfig().params);
  DriveTo(130.0, world, mapper);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> shift(-2.0, 2.0);
  for (Eigen::Vector2d& cone : world.mutable_cones())
    cone += Eigen::Vector2d(shift(random), shift(random));
  const GlobalMapEstimate after = DriveTo(LapWorld::kLap + 30.0, world, mapper);
  EXPECT_EQ(after.phase, MapPhase::kMapping);
}

TEST(GlobalMapper, CountsLapsAndNeitherGrowsNorDoublesOverThem) {
  LapWorld world({0.003, 0.0001});
  GlobalMapperParams params = ShippedConfig().params;
  params.map.max_keyframes = 200;
  GlobalMapper mapper(params);
  const GlobalMapEstimate two = DriveTo(2.0 * LapWorld::kLap + 20.0, world, mapper);
  const GlobalMapEstimate five = DriveTo(5.0 * LapWorld::kLap + 20.0, world, mapper);
  EXPECT_EQ(two.laps, 2);
  EXPECT_EQ(five.laps, 5);
  EXPECT_EQ(five.cones.size(), world.cones().size());
  EXPECT_LE(five.keyframes, 201);
  EXPECT_LT(WorstError(five, world), 0.5);
}

// The graph holds less than a lap then.
TEST(GlobalMapper, TellsTheWayOfEachLap) {
  LapWorld world({0.003, 0.0001});
  GlobalMapper mapper(ShippedConfig().params);
  double step = 0.0;
  int laps = 0;
  while (world.driven() < 3.0 * LapWorld::kLap + 20.0) {
    const GlobalMapper::Outcome outcome = mapper.AddLocalMap(world.Drive(step));
    step = kStep;
    if (outcome.driven.empty()) continue;
    EXPECT_EQ(outcome.estimate->laps, ++laps);
    double length = 0.0;
    for (size_t i = 1; i < outcome.driven.size(); ++i) {
      const double keyframe = (outcome.driven[i] - outcome.driven[i - 1]).norm();
      EXPECT_LT(keyframe, 2.0);
      length += keyframe;
    }
    EXPECT_GT(length, LapWorld::kLap - 5.0);
    EXPECT_LT(length, LapWorld::kLap + 50.0);
  }
  EXPECT_EQ(laps, 3);
}

TEST(GlobalMapper, GoesOnWhenTheLocalMapperBeginsANewEpoch) {
  LapWorld world({0.002, 0.0});
  GlobalMapper mapper(ShippedConfig().params);
  DriveTo(50.0, world, mapper);
  // What moved the car between the two epochs is in VELOCITY.
  for (int i = -20; i <= 40; ++i)
    mapper.AddVelocity(world.utime() + 10'000 * i, {LapWorld::kSpeed, 0.0, 0.0},
                       1e-4 * Eigen::Matrix3d::Identity());
  world.Restart();
  const GlobalMapEstimate after = DriveTo(70.0, world, mapper);
  EXPECT_LT((after.T_map_base.position() - world.T_map_base().position()).norm(), 1.0);
  EXPECT_LT(WorstError(after, world), 0.8);
}

TEST(GlobalMapper, ReplaysItsRecordsIntoTheSameMap) {
  for (const double distance : {70.0, LapWorld::kLap + 20.0, 2.0 * LapWorld::kLap}) {
    LapWorld world({0.003, 0.0002});
    GlobalMapper first(ShippedConfig().params);
    std::vector<MapRecord> records;
    const GlobalMapEstimate end = DriveTo(distance, world, first, &records);
    GlobalMapper second(ShippedConfig().params);
    second.Replay(records);
    const LocalMapInput next = world.Drive(kStep);
    const auto a = first.AddLocalMap(next).estimate;
    const auto b = second.AddLocalMap(next).estimate;
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->phase, b->phase);
    EXPECT_EQ(a->laps, b->laps);
    ASSERT_EQ(a->cones.size(), b->cones.size());
    for (size_t i = 0; i < a->cones.size(); ++i) {
      EXPECT_EQ(a->cones[i].id, b->cones[i].id);
      EXPECT_LT((a->cones[i].position - b->cones[i].position).norm(), 0.02) << distance;
    }
    EXPECT_LT((a->T_map_base.position() - b->T_map_base.position()).norm(), 0.02);
  }
}

TEST(GlobalMapper, RefusesTimeThatDoesNotIncrease) {
  LapWorld world({});
  GlobalMapper mapper(ShippedConfig().params);
  const LocalMapInput map = world.Drive(kStep);
  EXPECT_TRUE(mapper.AddLocalMap(map).estimate);
  EXPECT_EQ(mapper.AddLocalMap(map).refused, "time does not increase");
}

TEST(GlobalMapper, BoundsItsWorkUnderPhantomsAndAnEmptyMap) {
  GlobalMapperParams params = ShippedConfig().params;
  GlobalMapper mapper(params);
  LocalMapInput map{1'000'000, 1, {}, {}};
  EXPECT_TRUE(mapper.AddLocalMap(map).estimate->valid);
  int64_t id = 1;
  for (int k = 1; k <= 10; ++k) {
    map.utime += 100'000;
    map.T_local_base.x += 2.0;
    map.cones.clear();
    for (int i = 0; i < 500; ++i) {
      LocalMapCone cone{id++,           true, {}, 0.01 * Eigen::Matrix2d::Identity(),
                        kColourUnknown, 0.99, 9};
      cone.position =
          map.T_local_base * Eigen::Vector2d(0.4 * (i % 24) - 5.0, 0.41 * (i / 24) - 4.0);
      map.cones.push_back(cone);
    }
    const auto estimate = mapper.AddLocalMap(map).estimate;
    ASSERT_TRUE(estimate);
    EXPECT_LE(estimate->cones.size(), params.map.max_landmarks);
    EXPECT_NEAR(estimate->T_map_base.x, 2.0 * k, 0.5);
  }
}

// Cones that the car passed while nobody mapped are still in the local map.
TEST(GlobalMapper, TakesWhatWasPassedWhileItWasAway) {
  LapWorld world({0.001, 0.0});
  GlobalMapper first(ShippedConfig().params);
  std::vector<MapRecord> records;
  DriveTo(40.0, world, first, &records);
  LocalMapInput map;
  std::map<int64_t, LocalMapCone> passed;
  for (int i = 0; i < 24; ++i) {
    map = world.Drive(kStep);
    for (const LocalMapCone& cone : map.cones) {
      passed[cone.id] = cone;
      passed[cone.id].last_seen_utime = map.utime;
      passed[cone.id].seen_now = false;
    }
  }
  for (const LocalMapCone& cone : map.cones) passed.erase(cone.id);
  for (const auto& [id, cone] : passed) map.cones.push_back(cone);
  GlobalMapper second(ShippedConfig().params);
  second.Replay(records);
  const auto estimate = second.AddLocalMap(map).estimate;
  ASSERT_TRUE(estimate);
  for (const auto& [id, cone] : passed) {
    const Eigen::Vector2d position = estimate->T_map_local * cone.position;
    EXPECT_TRUE(std::any_of(estimate->cones.begin(), estimate->cones.end(), [&](const auto& c) {
      return (c.position - position).norm() < 0.5;
    })) << position.transpose();
  }
}

class Localisation : public ::testing::Test {
 protected:
  KnownMap Known() {
    LapWorld world({0.001, 0.0});
    GlobalMapper mapper(ShippedConfig().params);
    return {DriveTo(LapWorld::kLap + 20.0, world, mapper).cones, {}};
  }
};

TEST_F(Localisation, FindsTheStartFromStandstillAndFollowsTheCarRoundTheLap) {
  const KnownMap known = Known();
  LapWorld world({0.01, 0.0005}, 9);
  GlobalMapper mapper(ShippedConfig().params, known);
  for (int i = 0; i < 10; ++i) mapper.AddLocalMap(world.Drive(0.0));
  const auto standing = mapper.AddLocalMap(world.Drive(0.0)).estimate;
  ASSERT_EQ(standing->phase, MapPhase::kLocalised);
  EXPECT_LT((standing->T_map_base.position() - world.T_map_base().position()).norm(), 0.3);
  double worst = 0.0;
  double jump = 0.0;
  Pose2 T_map_local = standing->T_map_local;
  int laps = 0;
  while (world.driven() < 2.0 * LapWorld::kLap + 10.0) {
    const auto estimate = mapper.AddLocalMap(world.Drive(kStep)).estimate;
    ASSERT_EQ(estimate->phase, MapPhase::kLocalised) << world.driven();
    worst =
        std::max(worst, (estimate->T_map_base.position() - world.T_map_base().position()).norm());
    const Pose2 T_local_base = estimate->T_map_local.Inverse() * estimate->T_map_base;
    jump = std::max(
        jump, ((T_map_local * T_local_base).position() - estimate->T_map_base.position()).norm());
    T_map_local = estimate->T_map_local;
    laps = estimate->laps;
  }
  EXPECT_LT(worst, 0.5);
  EXPECT_LT(jump, 0.25);
  EXPECT_EQ(laps, 2);
}

TEST_F(Localisation, IsLostWhereTheConesAreElsewhereAndFoundAgain) {
  const KnownMap known = Known();
  LapWorld world({}, 4);
  GlobalMapper mapper(ShippedConfig().params, known);
  for (int i = 0; i < 10; ++i) mapper.AddLocalMap(world.Drive(0.0));
  ASSERT_EQ(DriveTo(30.0, world, mapper).phase, MapPhase::kLocalised);
  const std::vector<Eigen::Vector2d> truth = world.cones();
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> shift(-3.0, 3.0);
  for (Eigen::Vector2d& cone : world.mutable_cones())
    cone += Eigen::Vector2d(shift(random), shift(random));
  EXPECT_EQ(DriveTo(36.0, world, mapper).phase, MapPhase::kLost);
  world.mutable_cones() = truth;
  EXPECT_EQ(DriveTo(45.0, world, mapper).phase, MapPhase::kLocalised);
}

TEST(GlobalMapperParams, AreChecked) {
  GlobalMapperParams params = ShippedConfig().params;
  params.min_lap_distance = 0.0;
  EXPECT_THROW(GlobalMapper{params}, std::invalid_argument);
  params = ShippedConfig().params;
  params.map.covariance_inflation = 0.5;
  EXPECT_THROW(GlobalMapper{params}, std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
