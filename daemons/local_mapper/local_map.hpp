#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/cone.hpp"
#include "common/geometry.hpp"
#include "daemons/local_mapper/association.hpp"
#include "daemons/local_mapper/observation.hpp"
#include "daemons/local_mapper/pose_refinement.hpp"
#include "daemons/local_mapper/visibility.hpp"

namespace hairpin {

/// What a detector's hits and misses are worth.
struct DetectorModel {
  RecallByRange recall;
  double false_positive = 0.0;  // probability that a phantom is reported again, (0, 1)
};

/// How far a pipeline's word counts in a map mode.
struct Trust {
  double position_weight =
      1.0;                     // > 0; divides the covariance of an observation that corrects a cone
  double colour_weight = 1.0;  // >= 0
  bool refines_pose = false;   // by its cones: not where their errors are common, too
};

/// Hand-tuned growth of uncertainty by motion [paper III-C], per metre driven.
struct OdometryNoise {
  double position_sigma = 0.0;  // m per sqrt(m)
  double yaw_sigma = 0.0;       // rad per sqrt(m)
};

/// Existence of a cone, as probabilities; log-odds inside.
struct ExistenceParams {
  double at_first_sight = 0.0;
  double max = 0.0;  // certain: hits beyond it add nothing, so that misses soon tell
  double removed_below = 0.0;
  double max_credited_recall =
      0.0;  // misses of one cone in a row are no independent draws: bounds what each is worth
};

struct LocalMapParams {
  AssociationParams association;
  PoseRefinementParams refinement;
  double min_cone_distance = 0.0;  // m; no cone is added this near to another one
  OdometryNoise odometry;
  double unknown_colour_weight =
      0.0;  // of `unknown` in the sum of colours: no information is no vote; 1: plain sum
  ExistenceParams existence;
  VisibilityParams visibility;
  std::array<DetectorModel, kNumPipelines> detector;  // by Pipeline
  double forget_distance = 0.0;                       // m driven since a cone was last seen
  double forget_radius = 0.0;                         // m from the car
  size_t max_cones = 0;

  /// Throws std::invalid_argument naming parameter, relation and bound.
  void Validate() const;
};

/// One cone of the map, in local.
struct LocalCone {
  int64_t id = 0;  // stays with the cone as long as it lives
  int64_t last_seen_utime = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();        // m
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  // m^2
  ColourDistribution colour = kColourUnknown;
  double existence = 0.0;  // probability
  int num_observations = 0;
};

/// Feature-based single-hypothesis map of the cones recently observed, in the drifting frame of
/// dead reckoning. A Kalman filter per static landmark, Bhattacharyya association, colour as the
/// normalised sum of what was observed, and a negative observation model on existence. [paper
/// III-C, local map]
class LocalMap {
 public:
  /// Throws std::invalid_argument for bad parameters.
  explicit LocalMap(const LocalMapParams& params);

  /// Enters what a pipeline saw at `T_local_base`, the pose at `set.utime`. Sets may come out of
  /// order; the covariances grow by the motion since the newest one.
  void Update(const ObservationSet& set, const Pose2& T_local_base, const Trust& trust);

  /// The pose of a set that comes next, by its cones: see RefinePose().
  Pose2 Refine(const ObservationSet& set, const Pose2& predicted, const Eigen::Matrix3d& covariance,
               const Trust& trust) const;

  /// Grows the covariance of every cone by an uncertain motion that ended at `T_local_base`:
  /// isotropic by the position's variance [m^2], tangential by range^2 * the yaw's variance
  /// [rad^2].
  void AddMotionUncertainty(const Pose2& T_local_base, double position_variance,
                            double yaw_variance);

  /// Every cone, by rising id.
  std::vector<LocalCone> Cones() const;

 private:
  struct Landmark {
    int64_t id;
    int64_t last_seen_utime;
    double last_seen_driven;  // odometer [m]
    Gaussian2 state;
    ColourDistribution colour_sum;
    double log_odds;
    int num_observations;
    bool seen_in_this_set;
  };

  void Advance(int64_t utime, const Pose2& T_local_base);
  std::vector<std::optional<size_t>> AssociateWithLandmarks(
      const std::vector<Gaussian2>& observations_local) const;
  bool IsNew(const Eigen::Vector2d& position) const;
  void Correct(Landmark& landmark, const Gaussian2& observation, double position_weight) const;
  void CountHit(Landmark& landmark, const ConeObservation& cone, const ObservationSet& set,
                const Trust& trust) const;
  void CountMisses(const ObservationSet& set, const Pose2& T_local_base);
  void Forget(const Pose2& T_local_base);

  LocalMapParams params_;
  double min_log_odds_;
  double max_log_odds_;
  std::vector<Landmark> landmarks_;  // by rising id
  int64_t next_id_ = 1;
  int64_t utime_ = 0;  // of the newest set
  Pose2 T_local_base_;
  double driven_ = 0.0;  // odometer [m]
};

}  // namespace hairpin
