#include "daemons/path_tracker/speed_profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr SpeedProfileParams kParams{
    .max_speed = 12.0, .lateral_acceleration = 7.0, .braking = 9.0, .stop_margin = 0.5};

TEST(SpeedProfile, OnAStraightIsTheSpeedFromWhichTheCarCanStopBeforeTheEndOfWhatWasSeen) {
  const SpeedProfile profile(std::vector<double>(41, 0.0), 0.5, 10.0, kParams);
  for (double s = 0.0; s < 9.5; s += 0.1) {
    EXPECT_NEAR(profile.Stop(s).speed, std::min(12.0, std::sqrt(2.0 * 9.0 * (9.5 - s))), 1e-9) << s;
  }
  EXPECT_NEAR(profile.Stop(8.0).acceleration, -9.0, 1e-9);
  EXPECT_EQ(profile.Stop(9.5).speed, 0.0);
  EXPECT_EQ(profile.Stop(19.0).speed, 0.0);
  EXPECT_NEAR(profile.Corners(19.0).speed, 12.0, 1e-9);
}

TEST(SpeedProfile, KeepsTheLateralLimitInACornerEitherWay) {
  for (const double sign : {1.0, -1.0}) {
    const SpeedProfile profile(std::vector<double>(41, sign / 3.0), 0.5, 20.0, kParams);
    EXPECT_NEAR(profile.Corners(5.0).speed, std::sqrt(7.0 * 3.0), 1e-9);
  }
}

TEST(SpeedProfile, BrakesBeforeACornerWithinTheFrictionCircle) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> curvature(-0.35, 0.35);
  for (int run = 0; run < 200; ++run) {
    std::vector<double> k(40);
    for (double& value : k) value = curvature(random);
    const SpeedProfile profile(k, 0.5, 15.0, kParams);
    for (size_t i = 0; i + 1 < k.size(); ++i) {
      const double s = 0.5 * static_cast<double>(i);
      const double v0 = profile.Stop(s).speed;
      const double v1 = profile.Stop(s + 0.5).speed;
      EXPECT_LE(v0 * v0 * std::abs(k[i]), 7.0 + 1e-9);
      EXPECT_LE((v0 * v0 - v1 * v1) / (2.0 * 0.5), 9.0 + 1e-9);
      EXPECT_LE(v0, profile.Corners(s).speed + 1e-12);
    }
    EXPECT_EQ(profile.Stop(14.5).speed, 0.0);
  }
}

TEST(SpeedProfile, AllowsNothingWhereNothingWasSeen) {
  const SpeedProfile profile(std::vector<double>(21, 0.0), 0.5, 0.0, kParams);
  EXPECT_EQ(profile.Stop(0.0).speed, 0.0);
  EXPECT_EQ(profile.Stop(3.0).speed, 0.0);
}

TEST(SpeedProfile, RefusesWrongParametersAndInput) {
  const std::vector<double> k(5, 0.0);
  EXPECT_THROW(SpeedProfile(k, 0.5, 2.0, {0.0, 7.0, 9.0, 0.5}), std::invalid_argument);
  EXPECT_THROW(SpeedProfile(k, 0.5, 2.0, {12.0, 0.0, 9.0, 0.5}), std::invalid_argument);
  EXPECT_THROW(SpeedProfile(k, 0.5, 2.0, {12.0, 7.0, 0.0, 0.5}), std::invalid_argument);
  EXPECT_THROW(SpeedProfile(k, 0.5, 2.0, {12.0, 7.0, 9.0, -0.1}), std::invalid_argument);
  EXPECT_THROW(SpeedProfile({0.0}, 0.5, 2.0, kParams), std::invalid_argument);
  EXPECT_THROW(SpeedProfile(k, 0.0, 2.0, kParams), std::invalid_argument);
  EXPECT_THROW(SpeedProfile(k, 0.5, -1.0, kParams), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
