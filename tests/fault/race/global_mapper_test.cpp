// FAULTS row 41 in a whole race: global_mapper is killed in mid-lap.
#include <gtest/gtest.h>

#include "common/clock.hpp"
#include "tests/support/race_run.hpp"
#include "tools/report/map_comparison.hpp"

namespace hairpin {
namespace {

TEST(DeadDaemon, GlobalMapperComesBackWithItsMapAndTheCarDrivesOn) {
  const TemporaryFolder folder;
  const RaceRun run = RunInProcess(DefaultTrackFile(), 1, {"global_mapper off at 12 s for 1 s"},
                                   {"global_mapper.files.directory=" + folder.path()});
  EXPECT_TRUE(run.outcome.result.finished) << run.outcome.result.reason;
  EXPECT_EQ(run.outcome.result.cones_hit, 0);
  const int64_t killed = AddSeconds(GoTime(run.log), 12.0);
  const int64_t started = AddSeconds(killed, 1.0);
  int32_t before = 0;
  for (const global_map_t& map : run.log.global_maps) {
    if (map.utime <= killed) before = map.num_cones;
    if (map.utime > started) {
      EXPECT_GE(map.num_cones, before);
    }
  }
  const auto back = std::find_if(run.log.global_maps.begin(), run.log.global_maps.end(),
                                 [&](const global_map_t& map) { return map.utime > started; });
  ASSERT_NE(back, run.log.global_maps.end());
  EXPECT_LT(SecondsBetween(started, back->utime), 2.0);
  for (const pipeline_status_t& status : run.log.pipeline_status) {
    if (status.utime < GoTime(run.log)) continue;
    ASSERT_LE(status.level, pipeline_status_t::LEVEL_DEGRADE) << status.reason;
  }
  const auto comparison = CompareGlobalMap(run.log);
  ASSERT_TRUE(comparison);
  EXPECT_EQ(comparison->missed, 0);
  EXPECT_EQ(comparison->doubled, 0);
}

TEST(DeadDaemon, GlobalMapperForGoodDoesNotStopTheCar) {
  const RaceRun run = RunInProcess(DefaultTrackFile(), 1, {"global_mapper off at 8 s"});
  EXPECT_TRUE(run.outcome.result.finished) << run.outcome.result.reason;
}

}  // namespace
}  // namespace hairpin
