#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/cone.hpp"
#include "common/geometry.hpp"
#include "daemons/boundary_estimator/middle_path.hpp"
#include "daemons/boundary_estimator/one_sided.hpp"
#include "daemons/boundary_estimator/path_search.hpp"

namespace hairpin {

struct BoundaryEstimatorParams {
  double min_existence = 0.0;  // cones less certain than this are not used
  double near_min_existence =
      0.0;  // the same for cones nearer than near_range, which were looked at more often
  double near_range = 0.0;  // m
  double max_range = 0.0;   // m; nor cones farther from the car
  int max_cones = 0;        // nor more than this many, the nearest first
  double min_clear_share =
      0.0;  // with a smaller share of cones whose colour tells the side, the view is colour-blind
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

/// Numbered as on the wire. Colour-blind: (nearly) no cone's colour tells its side, so that
/// geometry alone decides. One-sided: beside the car the path rests on the cones of one side.
enum class Fallback { kUnknown = 0, kNone = 1, kColourBlind = 2, kOneSided = 3 };

/// Boundaries and middle path ahead, in local.
struct TrackEstimate {
  bool valid = false;
  Fallback fallback = Fallback::kNone;
  MiddlePath path;
  std::vector<BoundaryPoint> left;  // from the car outward
  std::vector<BoundaryPoint> right;
  int num_candidates = 0;
  PathScore winner;
  std::optional<PathScore> runner_up;
};

/// Track boundaries and middle path from the cones around the car: Delaunay triangulation, tree of
/// middle paths, Bayesian selection [paper III-D]. Where one side is missing, beside the car or
/// farther out, the other one leads on.
class BoundaryEstimator {
 public:
  /// Throws std::invalid_argument naming the parameter, the relation and the bound.
  explicit BoundaryEstimator(const BoundaryEstimatorParams& params);

  /// The order of the cones does not matter; their ids must differ. Remembers nothing but the width
  /// of the track.
  TrackEstimate Estimate(const Pose2& T_local_base, const std::vector<MapCone>& cones);

 private:
  struct Hypothesis {
    Stretch stretch;
    PathScore score;
  };
  Scene Select(const Pose2& T_base_local, const std::vector<MapCone>& cones) const;
  Hypothesis Complete(const Scene& scene, const ScoredPath& path,
                      const std::vector<Hypothesis>& one_sided) const;
  std::vector<Hypothesis> OneSided(const Scene& scene) const;
  bool Beats(const Scene& scene, const Hypothesis& one_sided, const Hypothesis& searched) const;
  Fallback FallbackOf(const Scene& scene, const Stretch& stretch) const;
  void LearnWidth(const Stretch& stretch);

  BoundaryEstimatorParams params_;
  PathSearch search_;
  double width_seen_;  // m, of the track, in the latest path that showed it
};

}  // namespace hairpin
