#pragma once

#include <vector>

#include "common/cone.hpp"
#include "common/geometry.hpp"
#include "daemons/local_mapper/association.hpp"

namespace hairpin {

/// How far VELOCITY may be off for longer than a set of observations: scale and misalignment of its
/// sensors, stamps that differ.
struct PoseRefinementParams {
  double velocity_sigma = 1.0;  // m/s, > 0
  double yaw_rate_sigma = 1.0;  // rad/s, > 0
  double stamp_sigma = 0.0;     // s, >= 0: of VELOCITY's stamps against those of the observations
  size_t min_pairs = 3;         // cones known again that a pose is refined by, >= 2
};

/// What `params` allow a motion to be off: covariance of (x, y, yaw), base. `change`: of the
/// velocity meanwhile, which a delay makes an error of.
Eigen::Matrix3d MotionCovariance(const PoseRefinementParams& params, double duration,
                                 const Twist2& change);

/// The pose at which observations (base) fit known cones (local) best, near `predicted` as its
/// covariance (of x, y, yaw; base) tells: maximum a posteriori by Gauss-Newton, with the
/// association anew at each step. An error of the pose is common to all cones, which this takes out
/// before they are filtered one by one. `position_weight` divides the observations' covariances.
/// `predicted` comes back where fewer than `min_pairs` find a partner.
Pose2 RefinePose(const std::vector<Gaussian2>& cones, const std::vector<ConeObservation>& seen,
                 double position_weight, const Pose2& predicted, const Eigen::Matrix3d& covariance,
                 const AssociationParams& association, size_t min_pairs);

}  // namespace hairpin
