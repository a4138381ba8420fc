#include "daemons/path_tracker/path_tracker_node.hpp"

#include <gtest/gtest.h>

#include "tests/node/path_tracker/straight_drive.hpp"

namespace hairpin {
namespace {

class PathTrackerNodeTest : public StraightDrive {};

TEST_F(PathTrackerNodeTest, AnswersEachVelocityWithItsTime) {
  Run(0.5);
  EXPECT_EQ(commands, 50);
  EXPECT_EQ(command->utime, utime);
}

TEST_F(PathTrackerNodeTest, DrivesAlongThePathAndNamesIt) {
  Run(1.0);
  EXPECT_EQ(command->action, drive_command_t::ACTION_DRIVE);
  EXPECT_EQ(command->track_utime, utime - 100'000);
  EXPECT_GT(command->wheel_torque_nm[0], 10.0);
  EXPECT_EQ(command->brake, 0.0);
  EXPECT_NEAR(command->steering_angle_rad, 0.0, 1e-9);
  EXPECT_NEAR(command->lateral_error_m, 0.0, 1e-9);
  EXPECT_GT(command->target_speed_mps, 10.0);
  EXPECT_LE(command->target_speed_mps, 12.0);
}

TEST_F(PathTrackerNodeTest, HoldsBeforeItHearsThatTheCarDrives) {
  as_state.state = as_state_t::STATE_READY;
  velocity.vx_mps = 0.0;
  Run(1.0);
  EXPECT_EQ(command->action, drive_command_t::ACTION_HOLD);
  EXPECT_GT(command->brake, 0.1);
  for (const double torque : command->wheel_torque_nm) EXPECT_EQ(torque, 0.0);
}

TEST_F(PathTrackerNodeTest, StopsWithinHalfASecondOfTheLastPath) {
  Run(1.0);
  tracks_run = false;
  const int64_t last_path = command->track_utime;
  while (command->action == drive_command_t::ACTION_DRIVE && tick < 300) {
    Tick();
    if (utime - last_path > 300'000) {
      EXPECT_LE(command->target_acceleration_mps2, 0.0);
    }
  }
  EXPECT_EQ(command->action, drive_command_t::ACTION_STOP);
  EXPECT_EQ(command->utime - last_path, 510'000);
}

TEST_F(PathTrackerNodeTest, AnInvalidTrackKeepsTheLastPath) {
  Run(1.0);
  const int64_t last_path = command->track_utime;
  tracks_run = false;
  const int64_t refused = Health("TRACK").refused;
  track_t invalid{};
  invalid.utime = utime - 50'000;
  others.Publish(channels::kTrack, invalid);
  Run(0.1);
  EXPECT_EQ(command->track_utime, last_path);
  EXPECT_EQ(command->action, drive_command_t::ACTION_DRIVE);
  EXPECT_EQ(Health("TRACK").refused, refused);
}

TEST_F(PathTrackerNodeTest, StopsWithoutAMapModeOrAtALevelOfStop) {
  for (const int mode : std::initializer_list<int>{pipeline_status_t::MODE_UNKNOWN,
                                                   pipeline_status_t::MODE_NONE, 17}) {
    Run(0.5);
    EXPECT_EQ(command->action, drive_command_t::ACTION_DRIVE);
    status.map_mode = mode;
    Run(0.03);
    EXPECT_EQ(command->action, drive_command_t::ACTION_STOP) << mode;
    status.map_mode = pipeline_status_t::MODE_FUSION;
  }
  Run(0.5);
  status.level = pipeline_status_t::LEVEL_CONTROLLED_STOP;
  Run(0.03);
  EXPECT_EQ(command->action, drive_command_t::ACTION_STOP);
}

TEST_F(PathTrackerNodeTest, ObeysTheSpeedCap) {
  Run(1.0);
  status.speed_cap_mps = 3.0;
  Run(0.3);
  EXPECT_EQ(command->target_speed_mps, 3.0);
  EXPECT_LT(command->wheel_torque_nm[0], 0.0);
}

TEST_F(PathTrackerNodeTest, StopsWhileTheVelocityIsInvalid) {
  Run(1.0);
  velocity.valid = 0;
  Run(0.2);
  EXPECT_EQ(command->action, drive_command_t::ACTION_STOP);
  EXPECT_GT(command->brake, 0.2);
  EXPECT_EQ(command->utime, utime);
}

TEST_F(PathTrackerNodeTest, CountsWhatItRefuses) {
  Run(1.0);
  const auto refuse_track = [this](auto spoil) {
    track_t track = Track();
    track.utime = utime;
    spoil(track);
    const int64_t before = Health("TRACK").refused;
    others.Publish(channels::kTrack, track);
    transport.Drain();
    EXPECT_EQ(Health("TRACK").refused, before + 1);
  };
  refuse_track([](track_t& t) { t.utime -= 301'000; });
  refuse_track([](track_t& t) { t.path[3].x_m = 1e6; });
  refuse_track([](track_t& t) { t.seen_length_m = -1.0; });
  refuse_track([](track_t& t) {
    t.path.resize(1);
    t.num_points = 1;
  });
  refuse_track([](track_t& t) {
    t.path.resize(501);
    t.num_points = 501;
  });
  refuse_track([](track_t& t) {
    for (path_point_t& point : t.path) point.x_m = point.y_m = 0.0;
  });

  const auto refuse_velocity = [this](auto spoil) {
    velocity_t message = velocity;
    message.utime = utime + 1'000;
    spoil(message);
    const int64_t before = Health("VELOCITY").refused;
    const int answers = commands;
    others.Publish(channels::kVelocity, message);
    transport.Drain();
    EXPECT_EQ(Health("VELOCITY").refused, before + 1);
    EXPECT_EQ(commands, answers);
  };
  refuse_velocity([this](velocity_t& v) { v.utime = utime; });
  refuse_velocity([](velocity_t& v) { v.vx_mps = 61.0; });
  refuse_velocity([](velocity_t& v) { v.yaw_rate_radps = -16.0; });
  refuse_velocity([](velocity_t& v) { v.covariance[4] = -0.01; });

  as_state.utime -= 100'000;
  others.Publish(channels::kAsState, as_state);
  status.utime -= 100'000;
  others.Publish(channels::kPipelineStatus, status);
  transport.Drain();
  EXPECT_EQ(Health("AS_STATE").refused, 1);
  EXPECT_EQ(Health("PIPELINE_STATUS").refused, 1);
}

TEST(LoadPathTrackerParams, NamesEveryProblem) {
  const std::string directory = std::string(HAIRPIN_SOURCE_DIR) + "/config";
  const Config config =
      Config::FromText("max_speed_mps: 1000\nlookahead_time: 0.4\n", "x.yaml", directory);
  try {
    LoadPathTrackerParams(config);
    FAIL();
  } catch (const ConfigError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("max_speed_mps"), std::string::npos);
    EXPECT_NE(what.find("did you mean lookahead_time_s?"), std::string::npos);
    EXPECT_NE(what.find("braking_mps2: is missing"), std::string::npos);
  }
}

}  // namespace
}  // namespace hairpin
