#pragma once

#include "common/bus.hpp"
#include "common/config.hpp"
#include "daemons/path_tracker/path_tracker.hpp"

namespace hairpin {

/// Reads path_tracker.yaml and car.yaml; deadlines come from the channel table. Throws ConfigError.
PathTrackerParams LoadPathTrackerParams(const Config& config);

/// TRACK, RACE_LINE, PIPELINE_STATUS, AS_STATE, VELOCITY -> DRIVE_COMMAND, one for each VELOCITY,
/// with its utime.
class PathTrackerNode {
 public:
  PathTrackerNode(const PathTrackerParams& params, Bus& bus);
  PathTrackerNode(const PathTrackerNode&) = delete;
  PathTrackerNode& operator=(const PathTrackerNode&) = delete;

 private:
  void OnTrack(const track_t& message);
  void OnRaceLine(const race_line_t& message);
  void OnVelocity(const velocity_t& message);

  Bus& bus_;
  PathTracker tracker_;
};

}  // namespace hairpin
