// The missions on a straight, by the whole stack.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/race_run.hpp"

namespace hairpin {
namespace {

using testing::StartsWith;

RaceRun RunOnStraight(int32_t mission, uint64_t seed, std::vector<std::string> overrides = {}) {
  overrides.push_back("simulator.race_control.mission=" + std::to_string(mission));
  return RunInProcess(std::string(HAIRPIN_SOURCE_DIR) + "/config/tracks/acceleration.yaml", seed,
                      {}, overrides);
}

class Acceleration : public testing::TestWithParam<uint64_t> {};

TEST_P(Acceleration, IsDrivenCleanlyAndEndsStandingBehindTheFinish) {
  const RaceRun run = RunOnStraight(vehicle_t::MISSION_ACCELERATION, GetParam());
  const RaceResult& result = run.outcome.result;
  EXPECT_TRUE(result.finished) << result.reason;
  EXPECT_EQ(result.cones_hit, 0);
  EXPECT_EQ(result.off_course, 0);
  ASSERT_EQ(result.lap_times_s.size(), 1u);
  EXPECT_LT(result.lap_times_s[0], 9.0);
  EXPECT_EQ(run.log.as_states.back().state, as_state_t::STATE_FINISHED);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Acceleration, testing::Values(1, 2, 3));

TEST(BrakeTest, ReachesItsSpeedWithin20MetresAndStandsWithin10OfTheRes) {
  const RaceRun run = RunOnStraight(vehicle_t::MISSION_BRAKE_TEST, 1,
                                    {"simulator.race_control.res_stop_speed_mps=11.2",
                                     "simulator.referee.braking_distance_m=10"});
  const RaceResult& result = run.outcome.result;
  EXPECT_TRUE(result.finished) << result.reason;
  EXPECT_THAT(result.reason, StartsWith("brake test: stands "));
  EXPECT_EQ(result.cones_hit, 0);
  EXPECT_GE(result.max_speed_mps, 40.0 / 3.6);
  EXPECT_LE(result.distance_m, 1.7 + 20.0 + 10.0);
  EXPECT_EQ(run.log.as_states.back().state, as_state_t::STATE_EMERGENCY);
}

}  // namespace
}  // namespace hairpin
