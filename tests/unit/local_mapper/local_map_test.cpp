#include "daemons/local_mapper/local_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/local_mapper/params.hpp"

namespace hairpin {
namespace {

using test::Seen;
using test::SetAt;
using test::TestMapParams;

constexpr int64_t kStart = 1'000'000;
constexpr int64_t kCycle = 100'000;  // us

/// A map that is fed cycle by cycle.
class Feed {
 public:
  explicit Feed(const LocalMapParams& params = TestMapParams()) : map_(params) {}

  void Observe(const std::vector<ConeObservation>& cones, const Pose2& T_local_base = {},
               Pipeline pipeline = Pipeline::kFusion, const Trust& trust = {}) {
    map_.Update(SetAt(utime_, cones, pipeline), T_local_base, trust);
    utime_ += kCycle;
  }
  void Repeat(int times, const std::vector<ConeObservation>& cones,
              const Pose2& T_local_base = {}) {
    for (int i = 0; i < times; ++i) Observe(cones, T_local_base);
  }
  std::vector<LocalCone> cones() const { return map_.Cones(); }
  LocalMap& map() { return map_; }

 private:
  LocalMap map_;
  int64_t utime_ = kStart;
};

TEST(LocalMap, AveragesPositionsAsAKalmanFilterOfAStaticLandmark) {
  Feed feed;
  for (const double x : {5.0, 5.1, 4.9, 5.0}) feed.Observe({Seen(x, 1.0, ConeColour::kBlue, 0.1)});
  ASSERT_EQ(feed.cones().size(), 1u);
  const LocalCone cone = feed.cones().front();
  EXPECT_NEAR(cone.position.x(), 5.0, 1e-9);
  EXPECT_NEAR(cone.covariance(0, 0), 0.1 * 0.1 / 4.0, 1e-9);
  EXPECT_NEAR(cone.covariance(0, 1), 0.0, 1e-12);
  EXPECT_EQ(cone.num_observations, 4);
  EXPECT_EQ(cone.last_seen_utime, kStart + 3 * kCycle);
}

TEST(LocalMap, GrowsCovarianceByMotionAndTangentiallyByTheLever) {
  Feed feed;
  feed.Observe({Seen(10.0, 0.0, ConeColour::kBlue, 0.1)});
  feed.map().AddMotionUncertainty({}, 0.02 * 0.02, 0.01 * 0.01);
  const Eigen::Matrix2d P = feed.cones().front().covariance;
  EXPECT_NEAR(P(0, 0), 0.01 + 0.0004, 1e-12);
  EXPECT_NEAR(P(1, 1), 0.01 + 0.0004 + 0.01, 1e-12);  // (10 m * 0.01 rad)^2
  EXPECT_NEAR(P(0, 1), 0.0, 1e-12);
}

TEST(LocalMap, DoesNotBlurWhileTheCarStands) {
  Feed feed;
  feed.Observe({Seen(-5.0, 1.0)});
  feed.Repeat(100, {});
  EXPECT_NEAR(feed.cones().front().covariance(0, 0), 0.06 * 0.06, 1e-12);
}

TEST(LocalMap, RejectsACertainFalsePositiveWithinHalfASecond) {
  for (const double range : {3.0, 6.0, 10.0, 13.96}) {
    Feed feed;
    feed.Repeat(30, {Seen(range, 1.0)});
    ASSERT_NEAR(feed.cones().front().existence, 0.99, 1e-6) << range;
    feed.Repeat(4, {});  // the fourth is 0.4 s after it was last seen
    EXPECT_TRUE(feed.cones().empty()) << range;
  }
}

TEST(LocalMap, KeepsACertainConeThatIsMissedThreeTimesInARow) {
  Feed feed;
  feed.Repeat(5, {Seen(6.0, 1.0)});
  feed.Repeat(3, {});
  EXPECT_EQ(feed.cones().size(), 1u);
  feed.Repeat(2, {Seen(6.0, 1.0)});
  EXPECT_GT(feed.cones().front().existence, 0.95);
}

TEST(LocalMap, LetsMissesWeighLittleWhereRecallIsPoor) {
  Feed feed;
  feed.Repeat(5, {Seen(16.0, 1.0)});
  const double certain = feed.cones().front().existence;
  feed.Repeat(4, {});
  ASSERT_EQ(feed.cones().size(), 1u);
  EXPECT_GT(feed.cones().front().existence, 0.85);
  EXPECT_LT(feed.cones().front().existence, certain);
}

TEST(LocalMap, LetsMissesWeighNothingPastTheKnownRecall) {
  Feed feed;
  feed.Observe({Seen(20.5, 0.0)});
  feed.Repeat(50, {});
  EXPECT_NEAR(feed.cones().front().existence, 0.55, 1e-9);
}

TEST(LocalMap, ForgetsASingleFalseSightingAtItsFirstMiss) {
  Feed feed;
  feed.Observe({Seen(6.0, 1.0)});
  feed.Observe({});
  EXPECT_TRUE(feed.cones().empty());
}

TEST(LocalMap, KeepsAHiddenCone) {
  Feed feed;
  feed.Repeat(5, {Seen(10.0, 2.0)});
  feed.Repeat(50, {Seen(5.0, 1.0)});
  EXPECT_EQ(feed.cones().size(), 2u);
  EXPECT_NEAR(feed.cones().front().existence, 0.99, 1e-6);
}

TEST(LocalMap, KeepsAConeOutOfView) {
  Feed feed;
  feed.Repeat(5, {Seen(5.0, 1.5)});
  feed.Repeat(50, {}, {10.0, 0.0, 0.0});  // passed: behind the car now
  EXPECT_EQ(feed.cones().size(), 1u);
  feed.Repeat(5, {}, {0.0, 0.0, 0.0});  // the car backs up, and it is not there
  EXPECT_TRUE(feed.cones().empty());
}

TEST(LocalMap, KeepsConesInTheHalfOfTheViewThatIsBlind) {
  LocalMap map(TestMapParams());
  int64_t utime = kStart;
  for (int i = 0; i < 5; ++i)
    map.Update(SetAt(utime += kCycle, {Seen(6.0, 2.0), Seen(6.0, -2.0)}), {}, {});
  const std::vector<ViewSector> right_half{{-1.75, 0.0, 22.0}};
  for (int i = 0; i < 10; ++i) {
    map.Update({utime += kCycle, Pipeline::kFusion, right_half, {}}, {}, {});
  }
  ASSERT_EQ(map.Cones().size(), 1u);
  EXPECT_NEAR(map.Cones().front().position.y(), 2.0, 1e-6);
}

TEST(LocalMap, KeepsTheColourAsTheNormalisedSumOfWhatWasObserved) {
  LocalMapParams params = TestMapParams();
  params.unknown_colour_weight = 1.0;
  Feed feed(params);
  ConeObservation cone = Seen(5.0, 1.0);
  cone.colour = {0.2, 0.8, 0.0, 0.0, 0.0};
  feed.Observe({cone});
  cone.colour = {0.4, 0.0, 0.6, 0.0, 0.0};
  feed.Observe({cone});
  EXPECT_THAT(feed.cones().front().colour,
              testing::Pointwise(testing::DoubleNear(1e-12), {0.3, 0.4, 0.3, 0.0, 0.0}));
}

TEST(LocalMap, LetsAFewColouredSightingsOutweighManyUnknownOnes) {
  Feed feed;
  feed.Repeat(10, {Seen(12.0, 1.0, ConeColour::kUnknown)});
  feed.Repeat(3, {Seen(12.0, 1.0, ConeColour::kYellow)});
  EXPECT_EQ(MostProbable(feed.cones().front().colour), ConeColour::kYellow);
}

TEST(LocalMap, KeepsBothOrangeClasses) {
  Feed feed;
  feed.Repeat(3, {Seen(5.0, 1.0, ConeColour::kOrange), Seen(5.0, -1.0, ConeColour::kOrangeLarge)});
  EXPECT_EQ(MostProbable(feed.cones()[0].colour), ConeColour::kOrange);
  EXPECT_EQ(MostProbable(feed.cones()[1].colour), ConeColour::kOrangeLarge);
}

TEST(LocalMap, TakesThePositionFromTheLidarAndTheColourFromTheCamera) {
  const Trust lidar{.position_weight = 1.0, .colour_weight = 0.05};
  const Trust camera{.position_weight = 0.05, .colour_weight = 1.0};
  Feed feed;
  for (int i = 0; i < 10; ++i) {
    feed.Observe({Seen(8.0, 1.0, ConeColour::kYellow)}, {}, Pipeline::kLidar, lidar);
    feed.Observe({Seen(8.6, 1.0, ConeColour::kBlue, 0.4)}, {}, Pipeline::kCamera, camera);
  }
  ASSERT_EQ(feed.cones().size(), 1u);
  EXPECT_NEAR(feed.cones().front().position.x(), 8.0, 0.01);
  EXPECT_EQ(MostProbable(feed.cones().front().colour), ConeColour::kBlue);
}

TEST(LocalMap, DoesNotDoubleAConeThatIsReportedTwice) {
  Feed feed;
  feed.Repeat(5, {Seen(5.0, 1.0), Seen(5.0, 1.2)});
  EXPECT_EQ(feed.cones().size(), 1u);
}

TEST(LocalMap, KeepsAPairOfLargeOrangeConesApart) {
  Feed feed;
  feed.Repeat(5,
              {Seen(8.0, 2.0, ConeColour::kOrangeLarge), Seen(8.7, 2.0, ConeColour::kOrangeLarge)});
  ASSERT_EQ(feed.cones().size(), 2u);
  EXPECT_NEAR(feed.cones()[1].position.x() - feed.cones()[0].position.x(), 0.7, 0.01);
}

TEST(LocalMap, RotatingTheWorldRotatesTheMap) {
  const Pose2 turn{4.0, -3.0, 2.2};
  Feed plain;
  Feed turned;
  for (int i = 0; i < 8; ++i) {
    const Pose2 pose{0.8 * i, 0.1 * i * i, 0.05 * i};
    ConeObservation cone = Seen(9.0 - 0.8 * i, 1.0 - 0.1 * i);
    cone.covariance << 0.04, 0.01, 0.01, 0.02;
    plain.Observe({cone}, pose);
    turned.Observe({cone}, turn * pose);
  }
  ASSERT_EQ(plain.cones().size(), turned.cones().size());
  for (size_t i = 0; i < plain.cones().size(); ++i) {
    const LocalCone a = plain.cones()[i];
    const LocalCone b = turned.cones()[i];
    EXPECT_LT((turn * a.position - b.position).norm(), 1e-9);
    EXPECT_LT((RotateCovariance(a.covariance, turn.yaw) - b.covariance).norm(), 1e-9);
    EXPECT_NEAR(a.existence, b.existence, 1e-9);
  }
}

TEST(LocalMap, MirrorSwapsBlueAndYellow) {
  Feed plain;
  Feed mirrored;
  for (int i = 0; i < 6; ++i) {
    const double x = 8.0 - 0.5 * i;
    plain.Observe({Seen(x, 1.5, ConeColour::kBlue), Seen(x, -1.7, ConeColour::kYellow)},
                  {0.5 * i, 0.1 * i, 0.02 * i});
    mirrored.Observe({Seen(x, -1.5, ConeColour::kYellow), Seen(x, 1.7, ConeColour::kBlue)},
                     {0.5 * i, -0.1 * i, -0.02 * i});
  }
  ASSERT_EQ(plain.cones().size(), mirrored.cones().size());
  for (size_t i = 0; i < plain.cones().size(); ++i) {
    const LocalCone a = plain.cones()[i];
    const LocalCone b = mirrored.cones()[i];
    EXPECT_NEAR(a.position.x(), b.position.x(), 1e-9);
    EXPECT_NEAR(a.position.y(), -b.position.y(), 1e-9);
    EXPECT_NEAR(a.covariance(0, 1), -b.covariance(0, 1), 1e-12);
    EXPECT_NEAR(a.colour[1], b.colour[2], 1e-12);
    EXPECT_NEAR(a.colour[2], b.colour[1], 1e-12);
  }
}

TEST(LocalMap, ForgetsConesNotSeenFor40Metres) {
  Feed feed;
  feed.Repeat(3, {Seen(5.0, 1.5)});
  feed.Observe({}, {20.0, 0.0, 0.0});
  feed.Observe({}, {39.0, 0.0, 0.0});
  EXPECT_EQ(feed.cones().size(), 1u);
  feed.Observe({}, {41.0, 0.0, 0.0});
  EXPECT_TRUE(feed.cones().empty());
}

TEST(LocalMap, DoesNotMixASecondVisitAfterADriftedLapWithTheFirst) {
  Feed feed;
  feed.Repeat(5, {Seen(5.0, 1.5)});
  for (double x = 1.0; x <= 60.0; x += 1.0) feed.Observe({}, {x, 0.0, 0.0});
  for (double x = 60.0; x >= 0.0; x -= 1.0) feed.Observe({}, {x, 30.0, 0.0});
  feed.Repeat(5, {Seen(5.0, 1.5)}, {0.3, 0.2, 0.0});  // by dead reckoning, back at the start
  ASSERT_EQ(feed.cones().size(), 1u);
  EXPECT_NEAR(feed.cones().front().position.x(), 5.3, 1e-6);
  EXPECT_EQ(feed.cones().front().num_observations, 5);
}

TEST(LocalMap, StaysWithinItsCapAndDropsTheLeastCertain) {
  LocalMapParams params = TestMapParams();
  params.max_cones = 10;
  Feed feed(params);
  std::vector<ConeObservation> certain;
  for (int i = 0; i < 8; ++i) certain.push_back(Seen(2.0 + i, 2.0));
  feed.Repeat(4, certain);
  std::vector<ConeObservation> all = certain;
  for (int i = 0; i < 8; ++i) all.push_back(Seen(2.0 + i, -2.0));
  feed.Observe(all);
  ASSERT_EQ(feed.cones().size(), 10u);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(feed.cones()[static_cast<size_t>(i)].num_observations, 5);
}

TEST(LocalMap, TakesALateSetWithoutTurningTimeBack) {
  LocalMap map(TestMapParams());
  map.Update(SetAt(kStart, {Seen(6.0, 1.0)}), {}, {});
  map.Update(SetAt(kStart + 2 * kCycle, {Seen(5.0, 1.0)}), {1.0, 0.0, 0.0}, {});
  const Eigen::Matrix2d before = map.Cones().front().covariance;
  map.Update(SetAt(kStart + kCycle, {Seen(5.5, 1.0)}), {0.5, 0.0, 0.0}, {});
  ASSERT_EQ(map.Cones().size(), 1u);
  EXPECT_EQ(map.Cones().front().num_observations, 3);
  EXPECT_EQ(map.Cones().front().last_seen_utime, kStart + 2 * kCycle);
  EXPECT_LT(map.Cones().front().covariance(0, 0), before(0, 0));
}

}  // namespace
}  // namespace hairpin
