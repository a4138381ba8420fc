// FAULTS row 35, and a localisation that is lost in mid-lap: the car drives on, on sight.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/clock.hpp"
#include "tests/support/trackdrive_run.hpp"

namespace hairpin {
namespace {

TEST(LostLocalisation, MeansDrivingOnSightToTheEndWithoutAStepOfTheSteering) {
  const RaceRun run = RunTrackdrive(2, {"global_mapper off at 12 s"});
  EXPECT_TRUE(run.outcome.result.finished) << run.outcome.result.reason;
  EXPECT_EQ(run.outcome.result.cones_hit, 0);
  EXPECT_EQ(run.outcome.result.off_course, 0);
  const int64_t lost = AddSeconds(GoTime(run.log), 12.0);
  bool before = false;
  for (size_t i = 1; i < run.log.drive_commands.size(); ++i) {
    const drive_command_t& command = run.log.drive_commands[i];
    const double since = SecondsBetween(lost, command.utime);
    before = before || (since < 0.0 && command.on_race_line != 0);
    if (since > 0.4) {
      ASSERT_EQ(command.on_race_line, 0) << since;
    }
    // The hand-over is over in a second; later a new TRACK may ask for the whole rate limit of
    // 0.04, as on any lap on sight.
    if (std::abs(since) < 1.0) {
      const double last = run.log.drive_commands[i - 1].steering_angle_rad;
      EXPECT_LT(std::abs(command.steering_angle_rad - last), 0.03) << since;
    }
  }
  EXPECT_TRUE(before);
}

TEST(LostLocalisation, IsOverWhereTheMapperComesBack) {
  const TemporaryFolder folder;
  const RaceRun run = RunTrackdrive(2, {"global_mapper off at 12 s for 1 s"},
                                    {"global_mapper.files.directory=" + folder.path()});
  EXPECT_TRUE(run.outcome.result.finished) << run.outcome.result.reason;
  EXPECT_EQ(run.outcome.result.cones_hit, 0);
  EXPECT_EQ(run.outcome.result.lap_times_s.size(), 2u);
  const int64_t started = AddSeconds(GoTime(run.log), 13.0);
  for (const global_map_t& map : run.log.global_maps) {
    if (map.utime > AddSeconds(started, 0.5)) {
      ASSERT_EQ(map.phase, global_map_t::PHASE_LOCALISED);
    }
  }
  ASSERT_FALSE(run.log.drive_commands.empty());
  const auto on_line = std::count_if(
      run.log.drive_commands.begin(), run.log.drive_commands.end(),
      [&](const auto& c) { return c.utime > AddSeconds(started, 3.0) && c.on_race_line != 0; });
  EXPECT_GT(on_line, 500);
}

TEST(Localisation, NeverJumpsByMoreThanTheRaceLineMay) {
  const RaceRun run = RunTrackdrive(2);
  ASSERT_GT(run.log.race_lines.size(), 100u);
  for (size_t i = 1; i < run.log.race_lines.size(); ++i) {
    const race_line_t& a = run.log.race_lines[i - 1];
    const race_line_t& b = run.log.race_lines[i];
    const double seconds = SecondsBetween(a.utime, b.utime);
    const double moved = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    EXPECT_LT(moved, 21.0 * seconds + 0.3) << b.utime;
  }
}

}  // namespace
}  // namespace hairpin
