#include "daemons/local_mapper/local_map.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr Require require("local_mapper");

double LogOdds(double probability) { return std::log(probability / (1.0 - probability)); }
double Probability(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

/// ln(P(hit | cone) / P(hit | phantom)); never against the cone, however small the recall.
double HitWeight(double recall, double false_positive) {
  return std::max(0.0, std::log(std::max(recall, false_positive) / false_positive));
}

/// ln(P(miss | cone) / P(miss | phantom)), <= 0.
double MissWeight(double recall, double false_positive) {
  return std::min(0.0, std::log((1.0 - recall) / (1.0 - false_positive)));
}

/// Scaled by what is known: colours in full, `unknown` by its weight.
void AddColour(ColourDistribution& sum, const ColourDistribution& colour, double weight,
               double unknown_weight) {
  for (size_t i = 0; i < sum.size(); ++i) {
    const bool unknown = i == static_cast<size_t>(ConeColour::kUnknown);
    sum[i] += weight * (unknown ? unknown_weight : 1.0) * colour[i];
  }
}

}  // namespace

void LocalMapParams::Validate() const {
  const auto open_unit = [](double p) { return p > 0.0 && p < 1.0; };
  require(association.gate_chi2 > 0.0, "gate_chi2 must be > 0");
  require(association.gate_sigma >= 0.0, "gate_sigma must be >= 0");
  require(min_cone_distance >= 0.0, "min_cone_distance must be >= 0");
  require(odometry.position_sigma >= 0.0, "odometry position_sigma must be >= 0");
  require(odometry.yaw_sigma >= 0.0, "odometry yaw_sigma must be >= 0");
  require(refinement.velocity_sigma > 0.0, "velocity_sigma must be > 0");
  require(refinement.yaw_rate_sigma > 0.0, "yaw_rate_sigma must be > 0");
  require(refinement.stamp_sigma >= 0.0, "stamp_sigma must be >= 0");
  require(refinement.min_pairs >= 2, "min_pairs must be >= 2");
  require(unknown_colour_weight > 0.0 && unknown_colour_weight <= 1.0,
          "unknown_colour_weight must be in (0, 1]");
  require(open_unit(existence.removed_below), "existence removed_below must be in (0, 1)");
  require(existence.removed_below < existence.at_first_sight,
          "existence at_first_sight must be > removed_below");
  require(existence.at_first_sight < existence.max, "existence max must be > at_first_sight");
  require(open_unit(existence.max), "existence max must be in (0, 1)");
  require(open_unit(existence.max_credited_recall), "max_credited_recall must be in (0, 1)");
  require(visibility.bearing_margin >= 0.0, "bearing_margin must be >= 0");
  require(visibility.range_margin >= 0.0, "range_margin must be >= 0");
  require(visibility.occlusion_half_width > 0.0, "occlusion_half_width must be > 0");
  for (const DetectorModel& model : detector) {
    model.recall.Validate("recall");
    require(open_unit(model.false_positive), "false_positive must be in (0, 1)");
  }
  require(forget_distance > 0.0, "forget_distance must be > 0");
  require(forget_radius > 0.0, "forget_radius must be > 0");
  require(max_cones > 0, "max_cones must be > 0");
}

LocalMap::LocalMap(const LocalMapParams& params) : params_(params) {
  params_.Validate();
  min_log_odds_ = LogOdds(params_.existence.removed_below);
  max_log_odds_ = LogOdds(params_.existence.max);
}

void LocalMap::Update(const ObservationSet& set, const Pose2& T_local_base, const Trust& trust) {
  Advance(set.utime, T_local_base);
  std::vector<Gaussian2> observations;  // in local
  observations.reserve(set.cones.size());
  for (const ConeObservation& cone : set.cones) {
    observations.push_back(
        {T_local_base * cone.position, RotateCovariance(cone.covariance, T_local_base.yaw)});
  }
  for (Landmark& landmark : landmarks_) landmark.seen_in_this_set = false;
  const auto landmark_of = AssociateWithLandmarks(observations);
  for (size_t i = 0; i < observations.size(); ++i) {
    if (!landmark_of[i]) continue;
    Landmark& landmark = landmarks_[*landmark_of[i]];
    Correct(landmark, observations[i], trust.position_weight);
    CountHit(landmark, set.cones[i], set, trust);
  }
  for (size_t i = 0; i < observations.size(); ++i) {
    if (landmark_of[i] || !IsNew(observations[i].mean)) continue;

    const double log_odds = LogOdds(params_.existence.at_first_sight);
    landmarks_.push_back({next_id_++, set.utime, driven_, observations[i], {}, log_odds, 1, true});
    AddColour(landmarks_.back().colour_sum, set.cones[i].colour, trust.colour_weight,
              params_.unknown_colour_weight);
  }
  CountMisses(set, T_local_base);
  Forget(T_local_base_);
}

void LocalMap::Advance(int64_t utime, const Pose2& T_local_base) {
  if (utime_ != 0 && utime <= utime_) return;
  if (utime_ != 0) {
    const double step = (T_local_base.position() - T_local_base_.position()).norm();
    driven_ += step;
    const OdometryNoise& noise = params_.odometry;
    AddMotionUncertainty(T_local_base, noise.position_sigma * noise.position_sigma * step,
                         noise.yaw_sigma * noise.yaw_sigma * step);
  }
  utime_ = utime;
  T_local_base_ = T_local_base;
}

void LocalMap::AddMotionUncertainty(const Pose2& T_local_base, double position_variance,
                                    double yaw_variance) {
  for (Landmark& landmark : landmarks_) {
    const Eigen::Vector2d r = landmark.state.mean - T_local_base.position();
    const Eigen::Vector2d lever(-r.y(), r.x());
    landmark.state.covariance += position_variance * Eigen::Matrix2d::Identity();
    landmark.state.covariance += yaw_variance * lever * lever.transpose();
  }
}

Pose2 LocalMap::Refine(const ObservationSet& set, const Pose2& predicted,
                       const Eigen::Matrix3d& covariance, const Trust& trust) const {
  std::vector<Gaussian2> sure;  // what was seen once only may be a phantom
  for (const Landmark& landmark : landmarks_) {
    if (landmark.num_observations > 1) sure.push_back(landmark.state);
  }
  return RefinePose(sure, set.cones, trust.position_weight, predicted, covariance,
                    params_.association, params_.refinement.min_pairs);
}

std::vector<std::optional<size_t>> LocalMap::AssociateWithLandmarks(
    const std::vector<Gaussian2>& observations_local) const {
  std::vector<Gaussian2> states;
  states.reserve(landmarks_.size());
  for (const Landmark& landmark : landmarks_) states.push_back(landmark.state);
  return Associate(states, observations_local, params_.association);
}

bool LocalMap::IsNew(const Eigen::Vector2d& position) const {
  const double min_squared = params_.min_cone_distance * params_.min_cone_distance;
  return std::none_of(landmarks_.begin(), landmarks_.end(), [&](const Landmark& landmark) {
    return (landmark.state.mean - position).squaredNorm() < min_squared;
  });
}

void LocalMap::Correct(Landmark& landmark, const Gaussian2& observation,
                       double position_weight) const {
  Eigen::Matrix2d& P = landmark.state.covariance;
  const Eigen::Matrix2d R = observation.covariance / position_weight;
  const Eigen::Matrix2d K = P * (P + R).inverse();
  landmark.state.mean += K * (observation.mean - landmark.state.mean);
  // Joseph form: stays symmetric and positive definite.
  const Eigen::Matrix2d I_K = Eigen::Matrix2d::Identity() - K;
  P = (I_K * P * I_K.transpose() + K * R * K.transpose()).eval();
}

void LocalMap::CountHit(Landmark& landmark, const ConeObservation& cone, const ObservationSet& set,
                        const Trust& trust) const {
  const DetectorModel& detector = params_.detector[static_cast<size_t>(set.pipeline)];
  const double recall =
      std::min(detector.recall.At(cone.position.norm()), params_.existence.max_credited_recall);
  landmark.log_odds =
      std::min(landmark.log_odds + HitWeight(recall, detector.false_positive), max_log_odds_);
  AddColour(landmark.colour_sum, cone.colour, trust.colour_weight, params_.unknown_colour_weight);
  landmark.last_seen_utime = std::max(landmark.last_seen_utime, set.utime);
  landmark.last_seen_driven = driven_;
  landmark.num_observations += 1;
  landmark.seen_in_this_set = true;
}

void LocalMap::CountMisses(const ObservationSet& set, const Pose2& T_local_base) {
  const DetectorModel& detector = params_.detector[static_cast<size_t>(set.pipeline)];
  const Pose2 T_base_local = T_local_base.Inverse();
  std::vector<Eigen::Vector2d> cones_base;
  cones_base.reserve(landmarks_.size());
  for (const Landmark& landmark : landmarks_)
    cones_base.push_back(T_base_local * landmark.state.mean);
  for (size_t i = 0; i < landmarks_.size(); ++i) {
    if (landmarks_[i].seen_in_this_set) continue;
    const double recall =
        std::min(detector.recall.At(cones_base[i].norm()), params_.existence.max_credited_recall);
    if (recall <= detector.false_positive) continue;
    if (!InView(set.sectors, cones_base[i], params_.visibility)) continue;
    if (IsHidden(cones_base[i], cones_base, params_.visibility)) continue;
    landmarks_[i].log_odds += MissWeight(recall, detector.false_positive);
  }
}

void LocalMap::Forget(const Pose2& T_local_base) {
  std::erase_if(landmarks_, [&](const Landmark& landmark) {
    const double range = (landmark.state.mean - T_local_base.position()).norm();
    return landmark.log_odds < min_log_odds_ || range > params_.forget_radius ||
           driven_ - landmark.last_seen_driven > params_.forget_distance;
  });
  if (landmarks_.size() <= params_.max_cones) return;
  std::stable_sort(landmarks_.begin(), landmarks_.end(),
                   [](const Landmark& a, const Landmark& b) { return a.log_odds > b.log_odds; });
  landmarks_.resize(params_.max_cones);
  std::sort(landmarks_.begin(), landmarks_.end(),
            [](const Landmark& a, const Landmark& b) { return a.id < b.id; });
}

std::vector<LocalCone> LocalMap::Cones() const {
  std::vector<LocalCone> cones;
  cones.reserve(landmarks_.size());
  for (const Landmark& landmark : landmarks_) {
    const ColourDistribution colour = Normalised(landmark.colour_sum).value_or(kColourUnknown);
    cones.push_back({landmark.id, landmark.last_seen_utime, landmark.state.mean,
                     landmark.state.covariance, colour, Probability(landmark.log_odds),
                     landmark.num_observations});
  }
  return cones;
}

}  // namespace hairpin
