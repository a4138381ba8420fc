#include "daemons/global_mapper/race_line/lap_speed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/race_line/synthetic_lap.hpp"

namespace hairpin {
namespace {

// Two straights of 100 m and two half circles of 10 m radius.
std::vector<double> Stadium(double spacing) {
  std::vector<double> curvature;
  for (int half = 0; half < 2; ++half) {
    curvature.insert(curvature.end(), static_cast<size_t>(100.0 / spacing), 0.0);
    curvature.insert(curvature.end(), static_cast<size_t>(31.4 / spacing), 0.1);
  }
  return curvature;
}

TEST(LapSpeeds, OnACircleAreThoseOfTheLateralLimit) {
  const auto params = TestRaceLineParams().speed;
  for (const double v : LapSpeeds(std::vector<double>(100, 0.1), 0.5, params))
    EXPECT_NEAR(v, std::sqrt(8.0 * 10.0), 1e-9);
}

TEST(LapSpeeds, OnACircleWithDownforceSolveForIt) {
  auto params = TestRaceLineParams().speed;
  params.downforce = 1.9;
  const double v = LapSpeeds(std::vector<double>(100, 0.1), 0.5, params).front();
  EXPECT_NEAR(v * v * 0.1, 8.0 * (1.0 + 1.9 * v * v / (9.81 * 190.0)), 1e-9);
}

TEST(LapSpeeds, NeverLeaveTheFrictionEllipse) {
  const auto params = TestRaceLineParams().speed;
  const double h = 0.2;
  const std::vector<double> curvature = Stadium(h);
  const std::vector<double> v = LapSpeeds(curvature, h, params);
  for (size_t i = 0; i < v.size(); ++i) {
    const size_t j = (i + 1) % v.size();
    const double a = (v[j] * v[j] - v[i] * v[i]) / (2.0 * h);
    const size_t base = a > 0.0 ? i : j;  // the point whose limit the solver takes
    const double lateral = v[base] * v[base] * curvature[base] / params.lateral_acceleration;
    const double along = a > 0.0 ? a / params.acceleration : a / params.braking;
    EXPECT_LE(lateral * lateral + along * along, 1.0 + 1e-6) << i;
  }
}

TEST(LapSpeeds, BrakeAsLateAndAsHardAsPlanned) {
  const auto params = TestRaceLineParams().speed;
  const std::vector<double> v = LapSpeeds(Stadium(0.2), 0.2, params);
  EXPECT_NEAR(*std::max_element(v.begin(), v.end()), 20.0, 1e-9);
  // Ten metres before the corner at the end of the straight: v^2 = v_corner^2 + 2 a s.
  EXPECT_NEAR(v[450] * v[450], 8.0 * 10.0 + 2.0 * 9.0 * 10.0, 4.0);
}

TEST(LapSpeeds, AreLimitedByThePowerOfTheMotors) {
  auto params = TestRaceLineParams().speed;
  params.max_speed = 60.0;
  params.max_power = 9000.0;
  params.drag = 0.7;
  params.rolling_resistance = 180.0;
  const std::vector<double> v = LapSpeeds(std::vector<double>(4000, 1e-9), 0.5, params);
  // Where there is nothing to brake for, the speed at which the power goes into resistance.
  EXPECT_NEAR(v.front() * (0.7 * v.front() * v.front() + 180.0), 9000.0, 1.0);
}

TEST(LapTime, OfConstantSpeedIsLengthOverSpeed) {
  EXPECT_NEAR(LapTime(std::vector<double>(100, 10.0), 0.5), 5.0, 1e-12);
}

TEST(LapSpeeds, RefuseParametersOutOfBounds) {
  auto params = TestRaceLineParams().speed;
  params.max_power = 0.0;
  EXPECT_THROW(LapSpeeds(Stadium(0.2), 0.2, params), std::invalid_argument);
  EXPECT_THROW(LapSpeeds({0.0, 0.0}, 0.2, TestRaceLineParams().speed), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
