#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/channels.hpp"

namespace hairpin {

/// The messages of one run that evaluation reads, each channel in order of utime, duplicates (boot
/// id, sequence) once.
struct RunLog {
  std::vector<truth_t> truth;
  std::optional<truth_track_t> truth_track;  // the first: the track does not change during a run
  std::vector<local_map_t> local_maps;
  std::vector<global_map_t> global_maps;
  std::vector<track_t> tracks;
  std::vector<pipeline_status_t> pipeline_status;
  std::vector<as_state_t> as_states;
  std::vector<race_line_t> race_lines;
  std::vector<drive_command_t> drive_commands;
  std::vector<velocity_t> velocities;
  std::vector<gnss_t> gnss;
  std::vector<cones_t> cones_fusion;
  std::vector<cones_t> cones_lidar;
  std::vector<cones_t> cones_camera;

  int64_t events = 0;    // in the file
  int64_t first_us = 0;  // the earliest and the latest of their timestamps
  int64_t last_us = 0;
  int64_t undecodable = 0;    // on a channel read here, but of another type, malformed, or with NaN
  int64_t over_limit = 0;     // left out, since the log holds more than was to be kept
  int64_t skipped_bytes = 0;  // corrupt
};

/// How much of a log is held in memory, counted in payload bytes: some three hours of driving.
inline constexpr int64_t kMaxRunLogBytes = int64_t{1} << 30;

/// Reads a log. Bad messages and damaged stretches are counted, not fatal. Throws
/// std::runtime_error where the file cannot be read.
RunLog LoadRunLog(const std::string& path, int64_t max_bytes = kMaxRunLogBytes);

}  // namespace hairpin
