#include "daemons/local_mapper/local_mapper.hpp"

#include <gtest/gtest.h>

#include "tests/unit/local_mapper/params.hpp"

namespace hairpin {
namespace {

using test::Seen;
using test::SetAt;
using test::TestMapperParams;

constexpr int64_t kStart = 1'000'000;
constexpr int64_t kCycle = 100'000;
constexpr int64_t kTick = 10'000;

class LocalMapperTest : public testing::Test {
 protected:
  LocalMapperTest() : mapper_(TestMapperParams()) { mapper_.SetMode(MapMode::kFusion); }

  /// Velocities each 10 ms from the last one up to `until`.
  void Drive(int64_t until, const Twist2& velocity = {10.0, 0.0, 0.0}) {
    for (utime_ += kTick; utime_ <= until; utime_ += kTick) mapper_.AddVelocity(utime_, velocity);
    utime_ = until;
  }
  LocalMapper::Outcome Observe(int64_t utime, Pipeline pipeline,
                               std::vector<ConeObservation> cones = {}) {
    return mapper_.Observe(SetAt(utime, std::move(cones), pipeline));
  }

  LocalMapper mapper_;
  int64_t utime_ = kStart - kTick;
};

TEST_F(LocalMapperTest, PlacesDelayedObservationsByThePoseOfTheirTime) {
  Drive(kStart + 5 * kCycle);
  const auto outcome = Observe(kStart + 2 * kCycle, Pipeline::kFusion, {Seen(7.0, 1.0)});
  ASSERT_TRUE(outcome.map);
  EXPECT_EQ(outcome.map->utime, kStart + 2 * kCycle);
  EXPECT_NEAR(outcome.map->T_local_base.x, 2.0, 1e-9);  // 0.2 s at 10 m/s
  EXPECT_NEAR(outcome.map->cones.front().position.x(), 9.0, 1e-9);
}

TEST_F(LocalMapperTest, PutsOneConeSeenFromManyPlacesAtOnePlaceWhileTurning) {
  const Twist2 turning{8.0, 0.2, 0.9};
  Drive(kStart, turning);
  PoseHistory truth(1.0);
  for (int64_t t = kStart; t <= kStart + 10 * kCycle; t += kTick) truth.Add(t, turning);
  const Eigen::Vector2d cone_local(9.0, 3.0);
  for (int i = 1; i <= 9; ++i) {
    const int64_t seen_utime = kStart + i * kCycle;
    Drive(seen_utime + kCycle, turning);
    const Eigen::Vector2d cone_base = truth.At(seen_utime)->Inverse() * cone_local;
    const auto outcome =
        Observe(seen_utime, Pipeline::kFusion, {Seen(cone_base.x(), cone_base.y())});
    ASSERT_EQ(outcome.map->cones.size(), 1u);
    EXPECT_LT((outcome.map->cones.front().position - cone_local).norm(), 1e-6);
  }
}

TEST_F(LocalMapperTest, RefusesSetsLaterThanThePoseHistory) {
  Drive(kStart + 20 * kCycle);
  const auto outcome = Observe(kStart + 9 * kCycle, Pipeline::kFusion, {Seen(7.0, 1.0)});
  EXPECT_FALSE(outcome.map);
  EXPECT_EQ(outcome.refused, "later than the pose history");
  EXPECT_TRUE(Observe(kStart + 15 * kCycle, Pipeline::kFusion).map);  // 0.5 s late is in time
}

TEST_F(LocalMapperTest, RefusesSetsAheadOfTheNewestVelocity) {
  Drive(kStart + kCycle);
  EXPECT_EQ(Observe(kStart + 3 * kCycle, Pipeline::kFusion).refused,
            "ahead of the newest velocity");
}

TEST_F(LocalMapperTest, RefusesSetsBeforeAnyVelocity) {
  EXPECT_EQ(Observe(kStart, Pipeline::kFusion).refused, "no velocity yet");
}

TEST_F(LocalMapperTest, TakesReorderedSetsAndRefusesRepeatedOnes) {
  Drive(kStart + 4 * kCycle);
  EXPECT_TRUE(Observe(kStart + 2 * kCycle, Pipeline::kFusion, {Seen(7.0, 1.0)}).map);
  EXPECT_TRUE(Observe(kStart + kCycle, Pipeline::kFusion, {Seen(8.0, 1.0)}).map);
  EXPECT_EQ(Observe(kStart + 2 * kCycle, Pipeline::kFusion, {Seen(7.0, 1.0)}).refused,
            "seen before");
}

TEST_F(LocalMapperTest, PublishesNothingWithoutAMode) {
  Drive(kStart + 4 * kCycle);
  for (const MapMode mode : {MapMode::kUnknown, MapMode::kNone}) {
    mapper_.SetMode(mode);
    for (const Pipeline pipeline : {Pipeline::kFusion, Pipeline::kLidar, Pipeline::kCamera}) {
      const auto outcome = Observe(kStart + kCycle, pipeline, {Seen(7.0, 1.0)});
      EXPECT_FALSE(outcome.map);
      EXPECT_TRUE(outcome.refused.empty());
    }
  }
}

TEST_F(LocalMapperTest, UsesOnlyThePipelinesOfItsMode) {
  Drive(kStart + 9 * kCycle);
  int64_t utime = kStart;
  for (const MapMode mode :
       {MapMode::kFusion, MapMode::kLidarAndCamera, MapMode::kLidarOnly, MapMode::kCameraOnly}) {
    mapper_.SetMode(mode);
    utime += kCycle;
    for (const Pipeline pipeline : {Pipeline::kFusion, Pipeline::kLidar, Pipeline::kCamera}) {
      const auto outcome = Observe(utime, pipeline);
      EXPECT_EQ(outcome.map.has_value(), Uses(mode, pipeline)) << NameOf(mode);
      if (outcome.map) {
        EXPECT_EQ(outcome.map->mode, mode);
      }
    }
  }
}

TEST_F(LocalMapperTest, NeverMixesFusionWithSinglePipelinesInOneCycle) {
  Drive(kStart + 9 * kCycle);
  EXPECT_TRUE(Observe(kStart + kCycle, Pipeline::kFusion).map);
  mapper_.SetMode(MapMode::kLidarAndCamera);
  EXPECT_EQ(Observe(kStart + kCycle, Pipeline::kLidar).refused, "its scan was used already");
  EXPECT_EQ(Observe(kStart + kCycle + 3 * kTick, Pipeline::kCamera).refused,
            "its scan was used already");
  EXPECT_TRUE(Observe(kStart + 2 * kCycle, Pipeline::kLidar).map);
  EXPECT_TRUE(Observe(kStart + 2 * kCycle + 3 * kTick, Pipeline::kCamera).map);
  mapper_.SetMode(MapMode::kFusion);
  EXPECT_EQ(Observe(kStart + 2 * kCycle + 3 * kTick, Pipeline::kFusion).refused,
            "its scan was used already");
  EXPECT_TRUE(Observe(kStart + 3 * kCycle, Pipeline::kFusion).map);
}

TEST_F(LocalMapperTest, KeepsTheMapWhenTheModeChanges) {
  Drive(kStart + 9 * kCycle, {});
  for (int i = 0; i < 4; ++i) Observe(kStart + i * kCycle, Pipeline::kFusion, {Seen(7.0, 1.0)});
  mapper_.SetMode(MapMode::kCameraOnly);
  const auto outcome =
      Observe(kStart + 6 * kCycle, Pipeline::kCamera, {Seen(7.3, 1.0, ConeColour::kBlue, 0.35)});
  ASSERT_EQ(outcome.map->cones.size(), 1u);
  EXPECT_EQ(outcome.map->cones.front().id, 1);
  EXPECT_EQ(outcome.map->cones.front().num_observations, 5);
}

TEST_F(LocalMapperTest, RefusesVelocitiesThatCannotBe) {
  Drive(kStart + kCycle);
  EXPECT_EQ(mapper_.AddVelocity(kStart, {}), "time does not increase");
  EXPECT_EQ(mapper_.AddVelocity(kStart + kCycle, {}), "time does not increase");
  EXPECT_EQ(mapper_.AddVelocity(kStart + 2 * kCycle, {61.0, 0.0, 0.0}), "velocity out of range");
  EXPECT_EQ(mapper_.AddVelocity(kStart + 2 * kCycle, {0.0, 0.0, -10.1}), "velocity out of range");
  EXPECT_EQ(mapper_.AddVelocity(kStart + kCycle + kTick, {10.0, 0.0, 0.0}), "");
}

TEST_F(LocalMapperTest, DoesNotIntegrateAStaleVelocity) {
  Drive(kStart + 3 * kCycle);
  EXPECT_TRUE(Observe(kStart + 3 * kCycle, Pipeline::kFusion).map);
  EXPECT_EQ(Observe(kStart + 4 * kCycle + kTick, Pipeline::kFusion).refused,
            "ahead of the newest velocity");
}

TEST_F(LocalMapperTest, BlursTheMapByAShortGapAndRefusesSetsFromWithinIt) {
  Drive(kStart + 2 * kCycle);
  const auto before = Observe(kStart + 2 * kCycle, Pipeline::kFusion, {Seen(10.0, 0.0)});
  utime_ += 3 * kCycle - kTick;  // silence of 0.3 s
  Drive(kStart + 6 * kCycle);
  EXPECT_EQ(Observe(kStart + 4 * kCycle, Pipeline::kFusion).refused,
            "before a gap in the velocity");
  const auto after =
      mapper_.Observe({kStart + 6 * kCycle, Pipeline::kFusion, {}, {}});  // blind: no miss
  ASSERT_EQ(after.map->cones.size(), 1u);
  EXPECT_EQ(after.map->epoch, before.map->epoch);
  EXPECT_NEAR(after.map->T_local_base.x, 6.0, 1e-9);
  const double hidden = 0.3 * 0.3 / 12.0 * 10.0;  // m, what the gap may hide
  EXPECT_GT(after.map->cones.front().covariance(0, 0),
            before.map->cones.front().covariance(0, 0) + hidden * hidden);
}

TEST_F(LocalMapperTest, BeginsANewEpochAfterALongGap) {
  Drive(kStart + 2 * kCycle);
  const auto before = Observe(kStart + 2 * kCycle, Pipeline::kFusion, {Seen(10.0, 0.0)});
  EXPECT_EQ(before.map->epoch, kStart + 2 * kCycle);
  utime_ += 6 * kCycle;
  Drive(kStart + 12 * kCycle);
  const auto after = Observe(kStart + 12 * kCycle, Pipeline::kFusion, {Seen(4.0, 1.0)});
  EXPECT_EQ(after.map->epoch, kStart + 12 * kCycle);
  ASSERT_EQ(after.map->cones.size(), 1u);
  EXPECT_EQ(after.map->cones.front().num_observations, 1);
}

TEST_F(LocalMapperTest, RefusesASetOfPhantoms) {
  Drive(kStart + kCycle);
  const std::vector<ConeObservation> phantoms(201, Seen(5.0, 0.0));
  EXPECT_EQ(Observe(kStart, Pipeline::kFusion, phantoms).refused, "too many cones");
}

}  // namespace
}  // namespace hairpin
