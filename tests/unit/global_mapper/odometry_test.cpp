#include "daemons/global_mapper/odometry.hpp"

#include <gtest/gtest.h>

#include "tests/unit/global_mapper/lap_world.hpp"

namespace hairpin {
namespace {

constexpr int64_t kTick = 10'000;  // us

OdometryParams Params() { return ShippedConfig().params.odometry; }

TEST(VelocityOdometry, GivesAMotionOfWhichNothingWasHeardTheCovarianceOfOneThatWas) {
  VelocityOdometry odometry(Params());
  const Eigen::Matrix3d covariance = Eigen::Vector3d(4e-4, 9e-4, 1e-4).asDiagonal();
  constexpr int kTicks = 50;
  for (int i = 0; i <= kTicks; ++i)
    ASSERT_EQ(odometry.Add(1 + i * kTick, {10.0, 0.0, 0.2}, covariance), "");
  const auto heard = odometry.Between(1, 1 + kTicks * kTick);
  ASSERT_TRUE(heard);
  const Eigen::Matrix3d assumed = odometry.CovarianceOf(heard->T_from_to, 0.5);
  EXPECT_LT((assumed - heard->covariance).norm(), 0.03 * heard->covariance.norm())
      << assumed << "\n\n"
      << heard->covariance;
  EXPECT_GT(assumed(2, 2), 3.0 * CovarianceByDistance(Params(), heard->T_from_to)(2, 2));
}

TEST(VelocityOdometry, KnowsTheDistanceOnlyBeforeAnyVelocity) {
  const VelocityOdometry odometry(Params());
  const Pose2 motion{2.0, 0.1, 0.05};
  EXPECT_EQ(odometry.CovarianceOf(motion, 0.2), CovarianceByDistance(Params(), motion));
}

}  // namespace
}  // namespace hairpin
