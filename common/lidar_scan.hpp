#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "hairpin/lidar_scan_t.hpp"

namespace hairpin {

/// One return of a rotating LiDAR.
struct LidarPoint {
  Eigen::Vector3f position;  // sensor's frame at the time of the firing [m]
  uint8_t intensity;
  uint8_t ring;  // by elevation, 0 is the lowest
  float age;     // fired this long before the scan's utime [s]
};

/// Writes `points` into the message's bytes, with their number and checksum, in units of the
/// message's `coordinate_step_m` and `time_step_s`, which must be set. Coordinates and ages are
/// rounded to the nearest step. Throws std::invalid_argument where a step is not positive, or a
/// coordinate or an age does not fit into 16 bits of steps.
void PackPoints(std::span<const LidarPoint> points, lidar_scan_t& scan);

/// The inverse. Returns what is wrong with the message, or an empty text: lengths that contradict
/// each other, a checksum that does not fit (a message with a hole), steps, shares or elevations
/// that cannot be, a ring that is not in the table. `points` keeps its memory between calls; after
/// a problem it is empty.
std::string_view UnpackPoints(const lidar_scan_t& scan, std::vector<LidarPoint>& points);

}  // namespace hairpin
