#include <gtest/gtest.h>

#include "common/map_mode.hpp"
#include "tests/support/race_run.hpp"

namespace hairpin {
namespace {

// A few seconds of a lap, ended by the referee.
const std::vector<std::string> kShortLap{"simulator.referee.time_limit_per_lap_s=5"};

TEST(RawSensors, DriveTheCarByLidarAloneAtFiveMetresPerSecond) {
  const RaceRun run = RunInProcess(DefaultTrackFile(), 1, {}, kShortLap, SensorLevel::kRaw);
  EXPECT_EQ(run.outcome.result.cones_hit, 0);
  EXPECT_EQ(run.outcome.result.off_course, 0);
  ASSERT_FALSE(run.log.truth.empty());
  EXPECT_GT(run.log.truth.back().distance_m, 15.0);
  EXPECT_LT(run.outcome.result.max_speed_mps, 5.5);
  ASSERT_FALSE(run.log.pipeline_status.empty());
  EXPECT_EQ(run.log.pipeline_status.back().map_mode, static_cast<int>(MapMode::kLidarOnly));
}

}  // namespace
}  // namespace hairpin
