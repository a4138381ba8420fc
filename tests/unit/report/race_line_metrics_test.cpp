#include "tools/report/race_line_metrics.hpp"

#include <gtest/gtest.h>

#include "common/geometry.hpp"

namespace hairpin {
namespace {

// A car on the x axis of the truth at 10 m/s, in a map that is turned and moved; from 2 s on it
// follows the line, which it leaves for half a second at 4 s.
RunLog MakeRun(double localisation_error) {
  RunLog log;
  const Pose2 T_map_truth{5.0, -3.0, 0.7};
  for (int i = 0; i <= 600; ++i) {
    const int64_t utime = 1'000'000 + 10'000 * i;
    const double x = 0.1 * i;
    truth_t truth{};
    truth.utime = utime;
    truth.x_m = truth.distance_m = x;
    log.truth.push_back(truth);
    drive_command_t command{};
    command.utime = utime;
    command.action = drive_command_t::ACTION_DRIVE;
    command.on_race_line = i >= 200 && (i < 400 || i >= 450);
    command.lateral_error_m = 0.1;
    log.drive_commands.push_back(command);
    if (i % 10 == 0) {
      const Pose2 pose = T_map_truth * Pose2{x + (i > 0 ? localisation_error : 0.0), 0.0, 0.0};
      race_line_t line{};
      line.utime = utime;
      line.x_m = pose.x;
      line.y_m = pose.y;
      line.yaw_rad = pose.yaw;
      for (int k = 0; k < 100; ++k) {
        const Eigen::Vector2d point = T_map_truth * Eigen::Vector2d(x + 0.5 * k, 1.0);
        line.points.push_back({point.x(), point.y(), 10.0, 1.0, 1.0});
      }
      line.num_points = 100;
      log.race_lines.push_back(line);
    }
  }
  as_state_t state{};
  state.utime = 1'000'000;
  state.state = as_state_t::STATE_DRIVING;
  log.as_states.push_back(state);
  return log;
}

TEST(RaceLineMetrics, TellHowOftenAndHowWellTheLineWasFollowed) {
  const nlohmann::json figures = RaceLineJson(MakeRun(0.0));
  EXPECT_NEAR(figures["followed_percent"], 100.0 * 351 / 601, 0.1);
  EXPECT_EQ(figures["times_left"], 1);
  EXPECT_NEAR(figures["lateral_error_m"]["rms"], 0.1, 1e-9);
  EXPECT_NEAR(figures["localisation_m"]["max"], 0.0, 1e-9);
}

TEST(RaceLineMetrics, MeasureTheLocalisationInTheFrameOfTheFirstLine) {
  EXPECT_NEAR(RaceLineJson(MakeRun(0.2))["localisation_m"]["max"], 0.2, 1e-9);
}

TEST(RaceLineMetrics, AreNullWithoutALine) { EXPECT_TRUE(RaceLineJson({}).is_null()); }

TEST(RaceLineOfALap, LiesWhereTheTruthPutsIt) {
  const auto stretches = RaceLineOfALap(MakeRun(0.0));
  ASSERT_GE(stretches.size(), 2u);
  for (const auto& stretch : stretches) {
    for (const Eigen::Vector2d& point : stretch) EXPECT_NEAR(point.y(), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace hairpin
