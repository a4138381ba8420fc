#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/cone.hpp"
#include "common/errors.hpp"
#include "common/geometry.hpp"
#include "common/local_enu.hpp"

namespace hairpin {

/// A malformed or impossible track: "file:line: reason".
class TrackError : public InputError {
 public:
  using InputError::InputError;
};

struct TrackCone {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // map [m]
  ConeColour colour = ConeColour::kUnknown;
  std::optional<Eigen::Matrix2d> covariance{};  // of a surveyed position [m^2]
};

/// A line across the track, by the driver's view. It ends on the sides.
struct GateLine {
  Eigen::Vector2d left = Eigen::Vector2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
};

/// A track marked by cones, in map [m].
struct Track {
  std::string name;
  std::optional<GeodeticPoint> origin{};  // of map, x east and y north, where surveyed
  bool closed = true;                     // a lap; false: start and finish differ (acceleration)
  Pose2 start;                            // T_map_base of the car waiting, before the start line
  GateLine start_line;
  GateLine finish_line;          // the same line where closed
  std::vector<TrackCone> left;   // boundary in driving order from the start line on; blue or orange
  std::vector<TrackCone> right;  // yellow or orange
  std::vector<TrackCone>
      others;  // cones that bound nothing, such as large orange ones beside the gate
  std::vector<Eigen::Vector2d>
      clutter;  // things beside the track that a pipeline may take for a cone
};

/// Reads our own YAML, PacSim YAML, FSSIM YAML (told apart by their keys) or EUFS CSV;
/// config/tracks/README.md says how each is understood. What comes back is drivable: at least 3
/// cones a side, no two within 0.1 m, neighbours at most 10 m apart, sides that do not cross, 2 m
/// of width, the start between them, facing along them, and left of it the left side. Throws
/// TrackError with file, line and reason.
Track LoadTrack(const std::string& file);

/// Writes our own YAML, which LoadTrack() reads back exactly. Throws std::runtime_error where it
/// cannot write.
void SaveTrack(const Track& track, const std::string& file);

}  // namespace hairpin
