#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "daemons/path_tracker/path_tracker_node.hpp"

namespace hairpin {

/// The rest of the car on a straight, at a constant speed.
class StraightDrive : public testing::Test {
 protected:
  StraightDrive() {
    others.Subscribe(channels::kDriveCommand, [this](const drive_command_t& message) {
      command = message;
      ++commands;
    });
    status.map_mode = pipeline_status_t::MODE_FUSION;
    status.speed_cap_mps = 12.0;
    as_state.state = as_state_t::STATE_DRIVING;
    velocity.valid = 1;
    velocity.vx_mps = 5.0;
    velocity.covariance[0] = velocity.covariance[4] = velocity.covariance[8] = 0.01;
  }

  track_t Track() const {
    track_t track{};
    track.utime = utime - 100'000;
    track.valid = 1;
    track.seen_length_m = 13.0;
    track.length_m = 16.0;
    for (int i = 0; i <= 32; ++i) track.path.push_back({0.5 * i, 0.0, 3.0, i > 26});
    track.num_points = static_cast<int32_t>(track.path.size());
    return track;
  }

  // 0.4 m left of the car, in a map of its own, at 15 m/s.
  race_line_t RaceLine() const {
    race_line_t line{};
    line.utime = utime - 100'000;
    line.x_m = 40.0;
    line.y_m = 7.0 + driven - 0.1 * velocity.vx_mps;
    line.yaw_rad = std::numbers::pi / 2;
    line.pose_covariance[0] = line.pose_covariance[4] = 0.001;
    line.pose_covariance[8] = 1e-5;
    for (int i = -6; i <= 160; ++i)
      line.points.push_back({40.0 - race_line_left, line.y_m + 0.5 * i, 15.0, 1.1, 1.9});
    line.num_points = static_cast<int32_t>(line.points.size());
    return line;
  }

  void Tick() {
    utime += 10'000;
    ++tick;
    if (tick % 2 == 0) {
      status.utime = utime;
      others.Publish(channels::kPipelineStatus, status);
    }
    if (tick % 5 == 0) {
      as_state.utime = utime;
      others.Publish(channels::kAsState, as_state);
    }
    driven += velocity.vx_mps * 0.01;
    if (tick % 10 == 0 && tracks_run) others.Publish(channels::kTrack, Track());
    if (tick % 10 == 5 && race_lines_run) others.Publish(channels::kRaceLine, RaceLine());
    velocity.utime = utime;
    others.Publish(channels::kVelocity, velocity);
    transport.Drain();
  }
  void Run(double seconds) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds * 100.0)); ++i) Tick();
  }
  channel_health_t Health(const std::string& channel) const {
    for (const channel_health_t& health : bus.Health()) {
      if (health.channel == channel) return health;
    }
    return {};
  }

  Transport transport{"memq://"};
  Bus others{transport, "others", 1};
  Bus bus{transport, "path_tracker", 2};
  PathTrackerNode node{LoadPathTrackerParams(Config::Load(
                           std::string(HAIRPIN_SOURCE_DIR) + "/config", "path_tracker")),
                       bus};
  pipeline_status_t status{};
  as_state_t as_state{};
  velocity_t velocity{};
  bool tracks_run = true;
  bool race_lines_run = false;
  double race_line_left = 0.4;
  double driven = 0.0;
  std::optional<drive_command_t> command;
  int commands = 0;
  int64_t utime = 1'700'000'000'000'000;
  int tick = 0;
};

}  // namespace hairpin
