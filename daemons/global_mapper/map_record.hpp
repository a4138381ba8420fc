#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "common/cone.hpp"
#include "common/geometry.hpp"

namespace hairpin {

/// A landmark as a keyframe saw it.
struct SightingRecord {
  int64_t landmark = 0;
  int64_t local_id = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // base [m]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
  ColourDistribution colour{};     // what it adds to the landmark's sum
  int32_t num_observations = 0;    // what it adds to the landmark's count
  int32_t local_observations = 0;  // of the local cone in all
};

/// A keyframe of the map. Landmarks are numbered in the order of their first sightings.
struct KeyframeRecord {
  int64_t utime = 0;
  int64_t epoch = 0;
  Pose2 T_local_base;
  Pose2 T_map_base;     // as estimated then
  Pose2 T_before_base;  // motion since the keyframe before
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  std::vector<SightingRecord> sightings;
};

/// Pairs (landmark, into) that were found to be one cone. `loop`: they close the lap. `by_shape`:
/// odometry alone would not have believed it.
struct MergeRecord {
  int64_t utime = 0;
  bool loop = false;
  bool by_shape = false;
  std::vector<std::pair<int64_t, int64_t>> pairs;
};

/// Landmarks that were no cones.
struct RemovalRecord {
  int64_t utime = 0;
  std::vector<int64_t> landmarks;
};

/// The car's place in a known map, and its laps.
struct PlaceRecord {
  int64_t utime = 0;
  int64_t epoch = 0;
  Pose2 T_local_base;
  Pose2 T_map_base;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  // of T_map_base
  int64_t laps = 0;
  double odometer = 0.0;      // m
  double lap_odometer = 0.0;  // where the last lap ended
};

/// What happened to the map: replayed in order it is the map again. Of places the last one counts.
using MapRecord = std::variant<KeyframeRecord, MergeRecord, RemovalRecord, PlaceRecord>;

}  // namespace hairpin
