#include "common/geometry.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace hairpin {
namespace {

constexpr double kPi = std::numbers::pi;

void ExpectNear(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(WrapAngle(a.yaw - b.yaw), 0.0, tolerance);
}

TEST(WrapAngle, MapsBothEndsToPlusPi) {
  EXPECT_EQ(WrapAngle(kPi), kPi);
  EXPECT_EQ(WrapAngle(-kPi), kPi);
  EXPECT_EQ(WrapAngle(0.0), 0.0);
  EXPECT_LT(WrapAngle(std::nextafter(kPi, 4.0)), 0.0);
  EXPECT_GT(WrapAngle(std::nextafter(-kPi, 0.0)), -kPi);
}

TEST(WrapAngle, TakesAwayAnyNumberOfTurns) {
  for (const double turns : {-1e6, -1001.0, -2.0, -1.0, 1.0, 2.0, 1001.0, 1e6}) {
    for (const double angle : {-3.0, -1.0, 0.0, 0.5, 3.1})
      EXPECT_NEAR(WrapAngle(angle + turns * 2.0 * kPi), angle, 1e-8) << turns;
  }
}

TEST(WrapAngle, StaysWithinItsInterval) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-1000.0, 1000.0);
  for (int i = 0; i < 10'000; ++i) {
    const double wrapped = WrapAngle(angle(random));
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
  }
}

class RandomPoses : public testing::Test {
 protected:
  Pose2 Next() { return {meters_(random_), meters_(random_), angle_(random_)}; }

  std::mt19937 random_{7};
  std::uniform_real_distribution<double> meters_{-50.0, 50.0};
  std::uniform_real_distribution<double> angle_{-kPi, kPi};
};

TEST_F(RandomPoses, CancelTheirInverses) {
  for (int i = 0; i < 100; ++i) {
    const Pose2 pose = Next();
    ExpectNear(pose * pose.Inverse(), Pose2{}, 1e-12);
    ExpectNear(pose.Inverse() * pose, Pose2{}, 1e-12);
  }
}

TEST_F(RandomPoses, ComposeAssociativelyAndAsTheyMovePoints) {
  for (int i = 0; i < 100; ++i) {
    const Pose2 a = Next();
    const Pose2 b = Next();
    const Pose2 c = Next();
    ExpectNear((a * b) * c, a * (b * c), 1e-10);
    const Eigen::Vector2d point(1.0, -2.0);
    EXPECT_LT(((a * b) * point - a * (b * point)).norm(), 1e-10);
    EXPECT_LT((a.rotation() * point + a.position() - a * point).norm(), 1e-12);
  }
}

TEST(Pose2, TurnsCounterClockwise) {
  const Eigen::Vector2d left = Pose2{1.0, 2.0, kPi / 2.0} * Eigen::Vector2d(1.0, 0.0);
  EXPECT_NEAR(left.x(), 1.0, 1e-12);
  EXPECT_NEAR(left.y(), 3.0, 1e-12);
}

TEST(Integrate, EqualsManySmallSteps) {
  for (const double yaw_rate : {-2.0, -1e-3, -1e-6, 0.0, 1e-9, 9.9e-5, 1.1e-4, 0.5, 3.0}) {
    const Twist2 velocity{12.0, -0.7, yaw_rate};
    constexpr int kSteps = 100'000;
    constexpr double kDuration = 1.0;
    Pose2 pose;
    for (int i = 0; i < kSteps; ++i) {
      constexpr double kDt = kDuration / kSteps;
      const double middle = pose.yaw + 0.5 * yaw_rate * kDt;
      pose.x += (std::cos(middle) * velocity.vx - std::sin(middle) * velocity.vy) * kDt;
      pose.y += (std::sin(middle) * velocity.vx + std::cos(middle) * velocity.vy) * kDt;
      pose.yaw += yaw_rate * kDt;
    }
    ExpectNear(Integrate(velocity, kDuration), pose, 1e-7);
  }
}

TEST(Integrate, IsAQuarterOfACircle) {
  ExpectNear(Integrate({kPi / 2.0, 0.0, kPi / 2.0}, 1.0), {1.0, 1.0, kPi / 2.0}, 1e-12);
}

TEST(Integrate, IsContinuousWhereItChangesToTheSeries) {
  ExpectNear(Integrate({20.0, 1.0, 0.99999999e-4}, 1.0), Integrate({20.0, 1.0, 1.00000001e-4}, 1.0),
             1e-10);
}

TEST(Integrate, GoesBackInTimeByTheInverse) {
  const Twist2 velocity{8.0, 0.3, -0.9};
  ExpectNear(Integrate(velocity, -0.4), Integrate(velocity, 0.4).Inverse(), 1e-12);
}

TEST(RotateCovariance, TurnsTheLongAxis) {
  Eigen::Matrix2d forward;
  forward << 4.0, 0.0, 0.0, 1.0;
  const Eigen::Matrix2d turned = RotateCovariance(forward, kPi / 2.0);
  EXPECT_NEAR(turned(0, 0), 1.0, 1e-12);
  EXPECT_NEAR(turned(1, 1), 4.0, 1e-12);
  EXPECT_GT(RotateCovariance(forward, kPi / 4.0)(0, 1), 0.0);
  EXPECT_NEAR(RotateCovariance(forward, 0.7).determinant(), 4.0, 1e-12);
}

TEST(IsCovariance, TakesPositiveDefiniteMatricesOnly) {
  const auto check = [](double xx, double xy, double yx, double yy) {
    Eigen::Matrix2d matrix;
    matrix << xx, xy, yx, yy;
    return IsCovariance(matrix);
  };
  EXPECT_TRUE(check(1.0, 0.5, 0.5, 1.0));
  EXPECT_TRUE(check(1e-6, 0.0, 0.0, 1e-6));
  EXPECT_FALSE(check(0.0, 0.0, 0.0, 0.0));
  EXPECT_FALSE(check(1.0, 1.0, 1.0, 1.0)) << "singular";
  EXPECT_FALSE(check(1.0, 2.0, 2.0, 1.0));
  EXPECT_FALSE(check(-1.0, 0.0, 0.0, -1.0));
  EXPECT_FALSE(check(1.0, 0.1, 0.2, 1.0)) << "not symmetric";
  EXPECT_FALSE(check(std::nan(""), 0.0, 0.0, 1.0));
  EXPECT_FALSE(check(1.0, 0.0, 0.0, std::numeric_limits<double>::infinity()));
}

}  // namespace
}  // namespace hairpin
