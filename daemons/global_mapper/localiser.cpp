#include "daemons/global_mapper/localiser.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr Require require("global_mapper");

constexpr double kPlacedPositionSigma = 0.2;  // m: what the shape of the cones leaves open
constexpr double kPlacedYawSigma = 0.03;      // rad
constexpr double kFarAround = 30.0;  // m about the expected place that cones are compared in

using Jacobian = Eigen::Matrix<double, 2, 3>;

/// By (x, y, yaw) of the pose, of a point that lies `lever` from it, map.
Jacobian ByPose(const Eigen::Vector2d& lever) {
  Jacobian J = Jacobian::Zero();
  J.leftCols<2>().setIdentity();
  J(0, 2) = -lever.y();
  J(1, 2) = lever.x();
  return J;
}

}  // namespace

void LocaliserParams::Validate() const {
  constellation.Validate();
  require(filter.max_range > 0.0, "localisation max_range must be > 0");
  require(gate_chi2 > 0.0, "localisation gate_chi2 must be > 0");
  require(gate_distance > 0.0, "localisation gate_distance must be > 0");
  require(covariance_inflation >= 1.0, "localisation covariance_inflation must be >= 1");
  require(cone_sigma > 0.0, "localisation cone_sigma must be > 0");
  require(min_match_share > 0.0 && min_match_share <= 1.0,
          "localisation min_match_share must be in (0, 1]");
  require(max_unmatched > 0, "localisation max_unmatched must be > 0");
}

Localiser::Localiser(const LocaliserParams& params, std::vector<GlobalCone> cones,
                     const Pose2& start)
    : params_(params), cones_(std::move(cones)), pose_(start) {
  params.Validate();
  covariance_ = std::pow(params.constellation.max_translation, 2) * Eigen::Matrix3d::Identity();
  covariance_(2, 2) = std::pow(params.constellation.max_rotation, 2);
}

void Localiser::Predict(const Motion& motion) {
  const Eigen::Vector2d step = pose_.rotation() * motion.T_from_to.position();
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 2) = -step.y();
  F(1, 2) = step.x();
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G.topLeftCorner<2, 2>() = pose_.rotation();
  covariance_ = F * covariance_ * F.transpose() + G * motion.covariance * G.transpose();
  pose_ = pose_ * motion.T_from_to;
}

void Localiser::Resume(const Pose2& T_map_base, const Eigen::Matrix3d& covariance) {
  pose_ = T_map_base;
  covariance_ = covariance;
  localised_ = true;
  unmatched_ = 0;
}

void Localiser::Observe(const LocalMapInput& map, const std::optional<Motion>& motion) {
  if (motion) Predict(*motion);
  if (!localised_) {
    localised_ = Place(map);
    unmatched_ = 0;
    if (!localised_) return;
  }
  std::vector<const LocalMapCone*> near;
  for (const LocalMapCone& cone : map.cones) {
    if (params_.filter.Accepts(cone, map.T_local_base)) near.push_back(&cone);
  }
  const std::vector<Pairing> pairings = Associate(near, map);
  for (const Pairing& pairing : pairings) Correct(pairing, map);
  const auto wanted = params_.min_match_share * static_cast<double>(near.size());
  unmatched_ = static_cast<double>(pairings.size()) < wanted ? unmatched_ + 1 : 0;
  if (unmatched_ >= params_.max_unmatched) localised_ = false;
}

/// Finds the pose by the shape of all cones that the local map is fairly sure of.
bool Localiser::Place(const LocalMapInput& map) {
  std::vector<ConstellationPoint> seen;
  for (const LocalMapCone& cone : map.cones) {
    if (cone.existence < params_.filter.min_existence ||
        cone.num_observations < params_.filter.min_observations)
      continue;
    seen.push_back({map.T_local_base.Inverse() * cone.position, MostProbable(cone.colour)});
  }
  std::vector<ConstellationPoint> known;
  for (const GlobalCone& cone : cones_) {
    if ((cone.position - pose_.position()).norm() <= kFarAround)
      known.push_back({cone.position, MostProbable(cone.colour)});
  }
  const auto match = MatchConstellation(seen, known, pose_, params_.constellation);
  if (!match) return false;
  pose_ = match->T_to_from;
  covariance_ = Eigen::Vector3d(std::pow(kPlacedPositionSigma, 2),
                                std::pow(kPlacedPositionSigma, 2), std::pow(kPlacedYawSigma, 2))
                    .asDiagonal();
  return true;
}

Eigen::Matrix2d Localiser::Noise(const LocalMapCone& cone, const GlobalCone& landmark,
                                 const Pose2& T_map_local) const {
  return params_.covariance_inflation * RotateCovariance(cone.covariance, T_map_local.yaw) +
         params_.cone_sigma * params_.cone_sigma * Eigen::Matrix2d::Identity() +
         landmark.covariance;
}

std::vector<Localiser::Pairing> Localiser::Associate(const std::vector<const LocalMapCone*>& cones,
                                                     const LocalMapInput& map) const {
  struct Candidate {
    double chi2;
    size_t cone;
    size_t landmark;
  };
  const Pose2 T_map_local = pose_ * map.T_local_base.Inverse();
  std::vector<Candidate> candidates;
  for (size_t c = 0; c < cones.size(); ++c) {
    const Eigen::Vector2d position = T_map_local * cones[c]->position;
    const Jacobian J = ByPose(position - pose_.position());
    for (size_t l = 0; l < cones_.size(); ++l) {
      const Eigen::Vector2d innovation = cones_[l].position - position;
      if (innovation.norm() > params_.gate_distance) continue;
      if (!AreCompatible(MostProbable(cones[c]->colour), MostProbable(cones_[l].colour))) continue;
      const Eigen::Matrix2d S =
          J * covariance_ * J.transpose() + Noise(*cones[c], cones_[l], T_map_local);
      const double chi2 = innovation.dot(S.inverse() * innovation);
      if (chi2 <= params_.gate_chi2) candidates.push_back({chi2, c, l});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.chi2, a.cone, a.landmark) < std::tie(b.chi2, b.cone, b.landmark);
  });
  std::set<size_t> cone_taken;
  std::set<size_t> landmark_taken;
  std::vector<Pairing> pairings;
  for (const Candidate& candidate : candidates) {
    if (cone_taken.contains(candidate.cone) || landmark_taken.contains(candidate.landmark))
      continue;
    cone_taken.insert(candidate.cone);
    landmark_taken.insert(candidate.landmark);
    pairings.push_back({cones[candidate.cone], &cones_[candidate.landmark]});
  }
  return pairings;
}

void Localiser::Correct(const Pairing& pairing, const LocalMapInput& map) {
  const Pose2 T_map_local = pose_ * map.T_local_base.Inverse();
  const Eigen::Vector2d position = T_map_local * pairing.cone->position;
  const Jacobian J = ByPose(position - pose_.position());
  const Eigen::Matrix2d R = Noise(*pairing.cone, *pairing.landmark, T_map_local);
  const Eigen::Matrix2d S = J * covariance_ * J.transpose() + R;
  const Eigen::Matrix<double, 3, 2> K = covariance_ * J.transpose() * S.inverse();
  const Eigen::Vector3d shift = K * (pairing.landmark->position - position);
  pose_ = {pose_.x + shift.x(), pose_.y + shift.y(), WrapAngle(pose_.yaw + shift.z())};
  // Joseph's form keeps it symmetric and positive.
  const Eigen::Matrix3d I_KJ = Eigen::Matrix3d::Identity() - K * J;
  covariance_ = I_KJ * covariance_ * I_KJ.transpose() + K * R * K.transpose();
}

}  // namespace hairpin
