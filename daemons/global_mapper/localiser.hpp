#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "daemons/global_mapper/constellation.hpp"
#include "daemons/global_mapper/map_estimate.hpp"
#include "daemons/global_mapper/odometry.hpp"

namespace hairpin {

struct LocaliserParams {
  ConeFilter filter;
  ConstellationParams constellation;  // of the first place, and of a place lost
  double gate_chi2 = 0.0;             // of a cone's innovation, > 0
  double gate_distance = 0.0;         // m, > 0
  double covariance_inflation = 0.0;  // of a local cone's covariance, >= 1
  double cone_sigma = 0.0;            // m, > 0
  double min_match_share = 0.0;  // of the cones near the car; below it a map counts as unmatched
  int max_unmatched = 0;         // local maps in a row, then the car is lost, > 0

  /// Throws std::invalid_argument naming parameter, relation and bound.
  void Validate() const;
};

/// The car's place in a finished map, whose cones stand: an extended Kalman filter of the pose,
/// begun from the shape of the cones about the start. Lost where too few of the cones that the car
/// sees are where the map has them, until their shape is found again.
class Localiser {
 public:
  /// `start`: about where the car will begin, in the map.
  Localiser(const LocaliserParams& params, std::vector<GlobalCone> cones, const Pose2& start);

  /// `motion`: since the map before; none before the first one or where it is not known.
  void Observe(const LocalMapInput& map, const std::optional<Motion>& motion);

  /// Goes on from a place that an earlier life knew.
  void Resume(const Pose2& T_map_base, const Eigen::Matrix3d& covariance);
  /// The place is to be found again by the shape of the cones, about where it is.
  void Lose() { localised_ = false; }

  bool localised() const { return localised_; }
  const Pose2& T_map_base() const { return pose_; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }
  const std::vector<GlobalCone>& cones() const { return cones_; }

 private:
  struct Pairing {
    const LocalMapCone* cone;
    const GlobalCone* landmark;
  };
  void Predict(const Motion& motion);
  bool Place(const LocalMapInput& map);
  std::vector<Pairing> Associate(const std::vector<const LocalMapCone*>& cones,
                                 const LocalMapInput& map) const;
  Eigen::Matrix2d Noise(const LocalMapCone& cone, const GlobalCone& landmark,
                        const Pose2& T_map_local) const;
  void Correct(const Pairing& pairing, const LocalMapInput& map);

  LocaliserParams params_;
  std::vector<GlobalCone> cones_;
  Pose2 pose_;
  Eigen::Matrix3d covariance_;
  bool localised_ = false;
  int unmatched_ = 0;
};

}  // namespace hairpin
