#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/cone.hpp"
#include "common/geometry.hpp"
#include "daemons/boundary_estimator/middle_path.hpp"
#include "daemons/boundary_estimator/path_search.hpp"
#include "daemons/boundary_estimator/one_sided.hpp"

namespace hairpin {

struct BoundaryEstimatorParams {
  double min_existence = 0.0;  // cones less certain than this are not used
  double max_range = 0.0;      // m; nor cones farther from the car
  int max_cones = 0;           // nor more than this many, the nearest first
  PathScoreParams score;
  PathSearchParams search;
  OneSidedParams one_sided;
  MiddlePathParams path;
};

/// A cone of the local map.
struct MapCone {
  int64_t id = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // local [m]
  ColourDistribution colour = kColourUnknown;
  double existence = 0.0;
};

/// A cone of a boundary, in local [m]; id 0 where it is inferred.
struct BoundaryPoint {
  int64_t id = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
};

enum class Fallback { kUnknown = 0, kNone = 1, kColourBlind = 2, kOneSided = 3 };

/// Boundaries and middle path ahead, in local.
struct TrackEstimate {
  bool valid = false;
  Fallback fallback = Fallback::kNone;
  MiddlePath path;
  std::vector<BoundaryPoint> left;   // from the car outward
  std::vector<BoundaryPoint> right;
  int num_candidates = 0;
  PathScore winner;
  std::optional<PathScore> runner_up;
};

/// Track boundaries and middle path from the cones around the car: Delaunay triangulation, tree of middle paths, Bayesian
/// selection [paper III-D].
class BoundaryEstimator {
 public:
  explicit BoundaryEstimator(const BoundaryEstimatorParams& params);

  /// The order of the cones does not matter.
  TrackEstimate Estimate(const Pose2& T_local_base, const std::vector<MapCone>& cones);

 private:
  struct Hypothesis {
    Stretch stretch;
    PathScore score;
  };
  Scene Select(const Pose2& T_base_local, const std::vector<MapCone>& cones) const;
  std::optional<Hypothesis> BestOneSided(const Scene& scene) const;

  BoundaryEstimatorParams params_;
  PathSearch search_;
  double width_seen_;  // m, of the track, in the latest path with cones on both sides
};

}  // namespace hairpin
