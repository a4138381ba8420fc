// FAULTS row 35, and a localisation that is lost in mid-lap: the car drives on, on sight.
#include <gtest/gtest.h>

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
    // No more than a new TRACK makes on sight; the rate limit is 0.04.
    if (std::abs(since) < 1.0) {
      const double last = run.log.drive_commands[i - 1].steering_angle_rad;
      EXPECT_LT(std::abs(command.steering_angle_rad - last), 0.036) << since;
    }
  }
  EXPECT_TRUE(before);
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
