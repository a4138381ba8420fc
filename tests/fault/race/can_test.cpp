// FAULTS rows 6, 24 and 29 in the race: the car speaks CAN, and whoever keeps it alive dies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/clock.hpp"
#include "tests/support/race_run.hpp"

namespace hairpin {
namespace {

RaceRun RunByCan(const std::vector<std::string>& faults) {
  return RunInProcess(DefaultTrackFile(), 1, faults, {}, SensorLevel::kCones, true);
}

TEST(RaceByCan, IsDrivenAsByMessagesAndRepeatsToTheByte) {
  const RaceRun by_can = RunByCan({});
  EXPECT_TRUE(by_can.outcome.result.finished) << by_can.outcome.result.reason;
  EXPECT_EQ(by_can.outcome.result.cones_hit, 0);
  EXPECT_EQ(by_can.outcome.result.off_course, 0);
  EXPECT_EQ(by_can.bytes, RunByCan({}).bytes);
}

class DeadByCan : public testing::TestWithParam<const char*> {};

TEST_P(DeadByCan, EndsTheHeartbeatAndTheEmergencyBrakeStopsTheCarOnTheTrack) {
  const RaceRun run = RunByCan({std::string(GetParam()) + " off at 8 s"});
  EXPECT_FALSE(run.outcome.result.finished);
  EXPECT_EQ(run.outcome.result.off_course, 0);
  const int64_t off = AddSeconds(GoTime(run.log), 8.0);
  double speed_before = 0.0;
  double speed_after = 0.0;  // one second on: 0.2 s until the heartbeat ceases, 0.2 s for the brake
  for (const truth_t& truth : run.log.truth) {
    const double speed = std::hypot(truth.vx_mps, truth.vy_mps);
    if (truth.utime < off) speed_before = speed;
    if (truth.utime < AddSeconds(off, 1.0)) speed_after = speed;
    if (truth.utime < AddSeconds(off, 3.0)) continue;
    ASSERT_LE(speed, 0.1) << truth.utime;
  }
  EXPECT_GT(speed_before, 4.0);
  EXPECT_LT(speed_after, speed_before - 3.0);
}

INSTANTIATE_TEST_SUITE_P(Daemons, DeadByCan,
                         testing::Values("velocity_estimator", "path_tracker", "watchdog",
                                         "mission_manager", "can_gateway"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace hairpin
