#include <gtest/gtest.h>

#include <algorithm>

#include "tests/node/path_tracker/straight_drive.hpp"

namespace hairpin {
namespace {

class RaceLineTest : public StraightDrive {
 protected:
  RaceLineTest() {
    race_lines_run = true;
    status.speed_cap_mps = 30.0;
  }
  // Until the race line leads, or no longer does.
  double SecondsUntil(bool leads) {
    const int first = tick;
    while ((command->on_race_line != 0) != leads && tick < first + 1000) Tick();
    return 0.01 * (tick - first);
  }
};

TEST_F(RaceLineTest, IsFollowedAfterASecondOfHealthAtItsOwnSpeed) {
  Run(0.3);
  const double seconds = 0.3 + SecondsUntil(true);
  EXPECT_GE(seconds, 1.0 + 0.6);
  EXPECT_LE(seconds, 1.0 + 0.6 + 0.4);
  EXPECT_NEAR(command->target_speed_mps, 15.0, 1e-9);
  EXPECT_NEAR(command->lateral_error_m, -0.4, 0.01);
  EXPECT_GT(command->steering_angle_rad, 0.02);
}

TEST_F(RaceLineTest, IsNotFollowedWhereNoneComes) {
  race_lines_run = false;
  Run(4.0);
  EXPECT_EQ(command->on_race_line, 0);
  EXPECT_EQ(command->target_speed_mps, 12.0);
}

TEST_F(RaceLineTest, ThatCeasesIsLeftWithin300MsWithoutAStepOfTheSteering) {
  Run(4.0);
  ASSERT_NE(command->on_race_line, 0);
  race_lines_run = false;
  const int64_t last_line = command->track_utime;
  double before = command->steering_angle_rad;
  double step = 0.0;
  while (command->on_race_line != 0) {
    Tick();
    step = std::max(step, std::abs(command->steering_angle_rad - before));
    before = command->steering_angle_rad;
  }
  EXPECT_LE(utime - last_line, 310'000);
  EXPECT_LE(command->target_speed_mps, 12.0);
  for (int i = 0; i < 100; ++i) {
    Tick();
    step = std::max(step, std::abs(command->steering_angle_rad - before));
    before = command->steering_angle_rad;
  }
  EXPECT_NEAR(command->lateral_error_m, 0.0, 1e-6);
  EXPECT_NEAR(command->steering_angle_rad, 0.0, 1e-6);
  // At once it would be 0.3 rad, stretched to 0.04 a tick by the rate limit.
  EXPECT_LT(step, 0.01);
}

struct Doubt {
  const char* name;
  void (*spoil)(race_line_t& line);
};

class RaceLineInDoubt : public RaceLineTest, public testing::WithParamInterface<Doubt> {};

TEST_P(RaceLineInDoubt, IsLeftAtOnceAndFollowedAgainAfterASecondOfHealth) {
  Run(4.0);
  ASSERT_NE(command->on_race_line, 0);
  race_lines_run = false;
  race_line_t line = RaceLine();
  GetParam().spoil(line);
  others.Publish(channels::kRaceLine, line);
  Run(0.11);  // with the next TRACK at the latest
  EXPECT_EQ(command->on_race_line, 0);
  EXPECT_EQ(command->action, drive_command_t::ACTION_DRIVE);
  race_lines_run = true;
  const double seconds = SecondsUntil(true);
  EXPECT_GE(seconds, 1.0);
  EXPECT_LE(seconds, 2.2);
}

INSTANTIATE_TEST_SUITE_P(
    Doubts, RaceLineInDoubt,
    testing::Values(Doubt{"position", [](race_line_t& l) { l.pose_covariance[0] = 0.1; }},
                    Doubt{"heading", [](race_line_t& l) { l.pose_covariance[8] = 0.01; }},
                    Doubt{"jump", [](race_line_t& l) { l.x_m += 0.35; }}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST_F(RaceLineTest, BeyondTheBoundariesThatTrackSeesIsNotFollowed) {
  race_line_left = 1.1;  // 0.7 m of body and 1.1: beyond 1.5 m by 0.3
  Run(4.0);
  EXPECT_EQ(command->on_race_line, 0);
  EXPECT_NEAR(command->lateral_error_m, 0.0, 1e-6);
}

TEST_F(RaceLineTest, WithoutATrackIsNotFollowed) {
  Run(4.0);
  tracks_run = false;
  Run(1.0);
  EXPECT_EQ(command->on_race_line, 0);
  EXPECT_EQ(command->action, drive_command_t::ACTION_STOP);
}

TEST_F(RaceLineTest, LeavesCapsAndStopsInForce) {
  Run(4.0);
  ASSERT_NE(command->on_race_line, 0);
  status.speed_cap_mps = 5.0;
  Run(0.05);
  EXPECT_NE(command->on_race_line, 0);
  EXPECT_EQ(command->target_speed_mps, 5.0);
  status.level = pipeline_status_t::LEVEL_CONTROLLED_STOP;
  Run(0.05);
  EXPECT_EQ(command->action, drive_command_t::ACTION_STOP);
}

TEST_F(RaceLineTest, FastAtTheFinishTheCarBrakesAsHardAsTheDistanceNeeds) {
  velocity.vx_mps = 15.0;
  Run(4.0);
  as_state.mission_finished = 1;
  Run(0.2);
  EXPECT_EQ(command->action, drive_command_t::ACTION_STOP);
  EXPECT_NEAR(command->target_acceleration_mps2, -0.5 * 15.0 * 15.0 / 18.0, 1e-6);
}

TEST_F(RaceLineTest, ThatIsNonsenseIsRefusedAndCounted) {
  Run(1.0);
  const auto refuse = [this](auto spoil) {
    race_line_t line = RaceLine();
    line.utime = utime;
    spoil(line);
    const int64_t before = Health("RACE_LINE").refused;
    others.Publish(channels::kRaceLine, line);
    transport.Drain();
    EXPECT_EQ(Health("RACE_LINE").refused, before + 1);
  };
  refuse([](race_line_t& l) { l.utime -= 3'000'000; });
  refuse([](race_line_t& l) { l.points[3].x_m = 1e6; });
  refuse([](race_line_t& l) { l.points[3].speed_mps = -1.0; });
  refuse([](race_line_t& l) { l.pose_covariance[4] = -1.0; });
  refuse([](race_line_t& l) {
    l.points.resize(1);
    l.num_points = 1;
  });
  refuse([](race_line_t& l) {
    l.points.resize(501);
    l.num_points = 501;
  });
  refuse([](race_line_t& l) {
    for (race_line_point_t& point : l.points) point = l.points[0];
  });
}

}  // namespace
}  // namespace hairpin
