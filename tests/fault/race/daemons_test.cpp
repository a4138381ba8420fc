// FAULTS rows 21 and 23, and what follows when a daemon stays dead.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "common/clock.hpp"
#include "tests/support/race_run.hpp"

namespace hairpin {
namespace {

TEST(DeadDaemon, LocalMapperComesBackWithANewEpochAndTheLapIsFinished) {
  const RaceRun run = RunInProcess(DefaultTrackFile(), 1, {"local_mapper off at 8 s for 0.2 s"});
  std::set<int64_t> epochs;
  for (const local_map_t& map : run.log.local_maps) epochs.insert(map.epoch);
  EXPECT_EQ(epochs.size(), 2u);
  EXPECT_TRUE(run.outcome.result.finished) << run.outcome.result.reason;
  EXPECT_EQ(run.outcome.result.cones_hit, 0);
  EXPECT_EQ(run.outcome.result.off_course, 0);
}

class DeadForGood : public ::testing::TestWithParam<const char*> {};

TEST_P(DeadForGood, StopsTheCarOnTheTrack) {
  const RaceRun run =
      RunInProcess(DefaultTrackFile(), 1, {std::string(GetParam()) + " off at 8 s"});
  EXPECT_FALSE(run.outcome.result.finished);
  EXPECT_EQ(run.outcome.result.off_course, 0);
  const int64_t standing_by = AddSeconds(GoTime(run.log), 8.0 + 5.0);
  for (const truth_t& truth : run.log.truth) {
    if (truth.utime < standing_by) continue;
    ASSERT_LE(std::hypot(truth.vx_mps, truth.vy_mps), 0.1) << truth.utime;
  }
}

INSTANTIATE_TEST_SUITE_P(Daemons, DeadForGood,
                         ::testing::Values("velocity_estimator", "local_mapper",
                                           "boundary_estimator", "path_tracker", "watchdog",
                                           "mission_manager"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace hairpin
