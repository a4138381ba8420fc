#include "daemons/velocity_estimator/velocity_estimator_params.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/velocity_estimator/simulated_drive.hpp"

namespace hairpin {
namespace {

using ::testing::HasSubstr;

std::string ProblemWith(const std::function<void(VelocityEstimatorParams&)>& spoil) {
  VelocityEstimatorParams params = ShippedParams().estimator;
  spoil(params);
  try {
    VelocityEstimator estimator(params);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(VelocityEstimatorParams, AcceptsWhatIsShipped) {
  EXPECT_EQ(ProblemWith([](auto&) {}), "");
}

TEST(VelocityEstimatorParams, RefusesWithNameRelationAndBound) {
  EXPECT_THAT(ProblemWith([](auto& p) { p.noise.gyro = 0.0; }),
              HasSubstr("noise.gyro = 0 must be > 0"));
  EXPECT_THAT(ProblemWith([](auto& p) { p.motion.velocity = -1.0; }),
              HasSubstr("motion.velocity = -1 must be > 0"));
  EXPECT_THAT(
      ProblemWith([](auto& p) { p.slip.sigma_free = std::numeric_limits<double>::quiet_NaN(); }),
      HasSubstr("slip.sigma_free = nan must be > 0"));
  EXPECT_THAT(ProblemWith([](auto& p) { p.max_gap = 0.05; }),
              HasSubstr("max_gap = 0.05 must be >= max_age = 0.1"));
  EXPECT_THAT(ProblemWith([](auto& p) { p.max_gap = 3.0; }), HasSubstr("max_gap = 3 must be <= 2"));
  EXPECT_THAT(ProblemWith([](auto& p) { p.gate_2dof = 10.0; }),
              HasSubstr("gate_2dof = 10 must be > gate_1dof = 10.83"));
  EXPECT_THAT(ProblemWith([](auto& p) { p.car.wheel_radius = 0.0; }),
              HasSubstr("car.wheel_radius"));
  EXPECT_THAT(ProblemWith([](auto& p) { p.car.front_brake_share = 1.5; }),
              HasSubstr("car.front_brake_share"));
  EXPECT_THAT(ProblemWith([](auto& p) { p.monitor.frozen_after = 0.0; }),
              HasSubstr("monitor.frozen_after"));
  EXPECT_THAT(ProblemWith([](auto& p) { p.standstill.bias_window = 0.0; }),
              HasSubstr("standstill.bias_window"));
  EXPECT_THAT(ProblemWith([](auto& p) { p.vote.time_constant = 0.0; }),
              HasSubstr("vote.time_constant"));
}

}  // namespace
}  // namespace hairpin
