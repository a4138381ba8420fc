#include "common/pose_history.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr int64_t kStart = 1'700'000'000'000'000;
constexpr int64_t kTick = 10'000;

// A car on a circle of 9 m at 12 m/s, with a velocity each 10 ms.
class OnACircle : public testing::Test {
 protected:
  static constexpr double kRadius = 9.0;
  static constexpr Twist2 kVelocity{12.0, 0.0, 12.0 / kRadius};

  void DriveTo(int64_t utime) {
    for (; next_ <= utime; next_ += kTick) ASSERT_TRUE(history_.Add(next_, kVelocity));
  }
  static Pose2 Truth(int64_t utime) {
    const double angle = kVelocity.yaw_rate * static_cast<double>(utime - kStart) * 1e-6;
    return {kRadius * std::sin(angle), kRadius * (1.0 - std::cos(angle)), WrapAngle(angle)};
  }
  void ExpectTruthAt(int64_t utime) const {
    const auto pose = history_.At(utime);
    ASSERT_TRUE(pose) << utime - kStart;
    EXPECT_NEAR(pose->x, Truth(utime).x, 1e-3);
    EXPECT_NEAR(pose->y, Truth(utime).y, 1e-3);
    EXPECT_NEAR(WrapAngle(pose->yaw - Truth(utime).yaw), 0.0, 1e-4);
  }

  PoseHistory history_{0.5};
  int64_t next_ = kStart;
};

TEST_F(OnACircle, InterpolatesAlongTheArcToTheMillimetre) {
  DriveTo(kStart + 2'000'000);
  for (int64_t utime = kStart + 1'500'000; utime <= kStart + 2'000'000; utime += 777)
    ExpectTruthAt(utime);
}

TEST_F(OnACircle, InterpolatesAcrossLostVelocities) {
  history_.Add(kStart, kVelocity);
  history_.Add(kStart + 300'000, kVelocity);
  for (int64_t utime = kStart; utime <= kStart + 300'000; utime += 10'777) ExpectTruthAt(utime);
}

TEST_F(OnACircle, ExtrapolatesUpToItsBound) {
  DriveTo(kStart + 1'000'000);
  ExpectTruthAt(kStart + 1'100'000);
  EXPECT_FALSE(history_.At(kStart + 1'100'001));
}

TEST_F(OnACircle, KnowsNothingOfTheTimeBeforeItsHistory) {
  EXPECT_FALSE(history_.At(kStart));
  DriveTo(kStart + 100'000);
  EXPECT_FALSE(history_.At(kStart - 1));
  EXPECT_TRUE(history_.At(kStart));
  DriveTo(kStart + 5'000'000);
  EXPECT_TRUE(history_.At(kStart + 4'500'000)) << "the whole duration is kept";
  EXPECT_FALSE(history_.At(kStart + 4'400'000)) << "and no more: memory is bounded";
}

TEST_F(OnACircle, RefusesTimeThatDoesNotIncreaseAndChangesNothing) {
  DriveTo(kStart + 100'000);
  const Pose2 before = *history_.At(kStart + 100'000);
  EXPECT_FALSE(history_.Add(kStart + 100'000, {99.0, 0.0, 0.0}));
  EXPECT_FALSE(history_.Add(kStart, {99.0, 0.0, 0.0}));
  EXPECT_EQ(history_.newest_utime(), kStart + 100'000);
  EXPECT_EQ(history_.At(kStart + 100'000)->x, before.x);
}

TEST_F(OnACircle, CountsTheDistanceDriven) {
  DriveTo(kStart + 10'000'000);
  EXPECT_NEAR(history_.distance(), 120.0, 1e-6);
}

TEST(PoseHistory, IsTrapezoidalWhenTheSpeedChanges) {
  PoseHistory history(1.0);
  history.Add(kStart, {0.0, 0.0, 0.0});
  history.Add(kStart + 100'000, {1.0, 0.0, 0.0});
  EXPECT_NEAR(history.At(kStart + 100'000)->x, 0.05, 1e-12);
}

TEST(PoseHistory, StartsEmptyAtTheOrigin) {
  PoseHistory history(1.0);
  EXPECT_TRUE(history.empty());
  EXPECT_EQ(history.newest_utime(), 0);
  history.Add(kStart, {5.0, 0.0, 0.0});
  EXPECT_EQ(history.At(kStart)->x, 0.0);
}

TEST(PoseHistory, RefusesADurationThatIsNone) {
  EXPECT_THROW(PoseHistory(0.0), std::invalid_argument);
  EXPECT_THROW(PoseHistory(std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
