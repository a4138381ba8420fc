#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/trackdrive_run.hpp"

namespace hairpin {
namespace {

TEST(Trackdrive, OfTwoLapsOnTheMapOfAnAutocrossIsCleanAndAThirdFaster) {
  ASSERT_TRUE(DefaultTrackMapped().autocross.outcome.result.finished);
  const RaceRun run = RunTrackdrive(2);
  const RaceResult& result = run.outcome.result;
  EXPECT_TRUE(result.finished) << result.reason;
  EXPECT_EQ(result.cones_hit, 0);
  EXPECT_EQ(result.off_course, 0);
  EXPECT_EQ(result.lap_times_s.size(), 2u);
  EXPECT_GT(result.mean_speed_mps,
            1.3 * DefaultTrackMapped().autocross.outcome.result.mean_speed_mps);
  const auto on_line = std::count_if(run.log.drive_commands.begin(), run.log.drive_commands.end(),
                                     [](const auto& c) { return c.on_race_line != 0; });
  EXPECT_GT(on_line, 1000);
}

TEST(Trackdrive, TwiceMakesTheSameBytes) {
  EXPECT_TRUE(RunTrackdrive(1).bytes == RunTrackdrive(1).bytes);
}

TEST(Trackdrive, WithoutAMapIsRefusedAndSaysWhy) {
  const RaceRun run =
      RunInProcess(DefaultTrackFile(), 1, {},
                   {"simulator.race_control.mission=3", "simulator.referee.start_limit_s=10"});
  EXPECT_FALSE(run.outcome.result.finished);
  ASSERT_FALSE(run.log.as_states.empty());
  EXPECT_EQ(run.log.as_states.back().state, as_state_t::STATE_OFF);
  EXPECT_EQ(run.log.as_states.back().reason, "trackdrive: no map is loaded");
}

TEST(Trackdrive, WithAMapInHandAnAutocrossMapsAllTheSame) {
  const RaceRun run = RunInProcess(
      DefaultTrackFile(), 1, {},
      {"global_mapper.files.known_map=" + DefaultTrackMapped().folder.File("map.yaml")});
  EXPECT_TRUE(run.outcome.result.finished) << run.outcome.result.reason;
  EXPECT_TRUE(run.log.race_lines.empty());
  for (const drive_command_t& command : run.log.drive_commands) ASSERT_EQ(command.on_race_line, 0);
}

}  // namespace
}  // namespace hairpin
