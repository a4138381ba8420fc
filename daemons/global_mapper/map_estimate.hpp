#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/cone.hpp"
#include "common/geometry.hpp"

namespace hairpin {

/// A cone of the global map.
struct GlobalCone {
  int64_t id = 0;                                            // stays with it for the whole map
  Eigen::Vector2d position = Eigen::Vector2d::Zero();        // map [m]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  // m^2
  ColourDistribution colour = kColourUnknown;
  int num_observations = 0;
};

/// Numbered as on the wire.
enum class MapPhase { kUnknown = 0, kMapping = 1, kLoopClosed = 2, kLocalised = 3, kLost = 4 };

/// The global map and the car in it, after one local map.
struct GlobalMapEstimate {
  int64_t utime = 0;
  int64_t epoch = 0;  // of the local map
  bool valid = true;  // false: the last solve failed, this is the last good map
  MapPhase phase = MapPhase::kUnknown;
  Pose2 T_map_base;
  Eigen::Matrix3d pose_covariance = Eigen::Matrix3d::Identity();
  Pose2 T_map_local;
  int laps = 0;
  int keyframes = 0;  // in the graph
  std::vector<GlobalCone> cones;
};

/// The cones that a local map holds, as global_mapper needs them.
struct LocalMapCone {
  int64_t id = 0;
  bool seen_now = false;                                     // in the map's own set of observations
  Eigen::Vector2d position = Eigen::Vector2d::Zero();        // local [m]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  // m^2
  ColourDistribution colour = kColourUnknown;
  double existence = 0.0;
  int num_observations = 0;
  int64_t last_seen_utime = 0;
  bool seen_meanwhile = false;  // since the last local map that was taken, but not in this one
};

struct LocalMapInput {
  int64_t utime = 0;
  int64_t epoch = 0;
  Pose2 T_local_base;
  std::vector<LocalMapCone> cones;
};

/// Which cones of a local map are good enough for the global one [paper III-C].
struct ConeFilter {
  double max_range = 0.0;      // m from the car, > 0
  double min_existence = 0.0;  // 0 to 1
  int min_observations = 0;    // >= 1

  bool IsCertain(const LocalMapCone& cone) const {
    return cone.existence >= min_existence && cone.num_observations >= min_observations;
  }
  bool Accepts(const LocalMapCone& cone, const Pose2& T_local_base) const {
    return cone.seen_now && IsCertain(cone) &&
           (cone.position - T_local_base.position()).norm() <= max_range;
  }
};

}  // namespace hairpin
