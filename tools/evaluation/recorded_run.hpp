#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "daemons/boundary_estimator/boundary_estimator.hpp"
#include "tools/evaluation/recording_error.hpp"

namespace hairpin {

/// One moment of a recorded run, all in its map frame.
struct RecordedFrame {
  Pose2 T_map_base;
  std::optional<double> speed;  // m/s, where recorded
  std::vector<MapCone> cones;   // the map as it was known then
};

/// Reads a JSON list of frames {car_position: [x, y], car_direction: [dx, dy], car_speed,
/// slam_cones: five lists of [x, y]: unknown, yellow, blue, small orange, large orange}; metres,
/// m/s. Throws RecordingError.
std::vector<RecordedFrame> LoadRecordedRun(const std::string& file);

}  // namespace hairpin
