#include "daemons/global_mapper/pose_landmark_graph.hpp"

#include <algorithm>
#include <cmath>

#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr Require require("global_mapper");

constexpr double kAnchorVariance = 1e-8;  // m^2, rad^2: where the first pose is, is a definition

}  // namespace

void GraphParams::Validate() const {
  for (const SolverParams* solver : {&window, &full}) {
    require(solver->max_iterations > 0, "max_iterations must be > 0");
    require(solver->loss_scale >= 0.0, "loss_scale must be >= 0");
    require(solver->tolerance > 0.0, "tolerance must be > 0");
  }
  require(window_poses > 1, "window_poses must be > 1");
}

PoseLandmarkGraph::PoseLandmarkGraph(const GraphParams& params, const Pose2& first_pose)
    : params_(params),
      prior_(Eigen::Vector3d(first_pose.x, first_pose.y, first_pose.yaw), kAnchorVariance) {
  params.Validate();
  poses_.push_back({{first_pose.x, first_pose.y, first_pose.yaw}, {}, {}});
}

size_t PoseLandmarkGraph::AddPose(const OdometryMeasurement& odometry) {
  const Pose2 next = newest_pose() * odometry.T_from_to;
  const double yaw = poses_.back().x[2] + odometry.T_from_to.yaw;  // not wrapped
  poses_.push_back({{next.x, next.y, yaw}, odometry, {}});
  return end_pose() - 1;
}

size_t PoseLandmarkGraph::AddLandmark(const Eigen::Vector2d& position) {
  landmarks_.push_back({{position.x(), position.y()}, end_pose() - 1});
  return landmarks_.size() - 1;
}

void PoseLandmarkGraph::AddSighting(size_t landmark, const LandmarkMeasurement& measurement) {
  require(landmark < landmarks_.size() && landmarks_[landmark].alive,
          "a sighting of a landmark that there is not");
  poses_.back().sightings.push_back({landmark, measurement});
}

void PoseLandmarkGraph::MergeLandmark(size_t landmark, size_t into) {
  if (landmark == into) return;
  for (PoseNode& pose : poses_) {
    for (Sighting& sighting : pose.sightings) {
      if (sighting.landmark == landmark) sighting.landmark = into;
    }
  }
  landmarks_.at(landmark).alive = false;
  landmarks_.at(into).first_pose =
      std::min(landmarks_[into].first_pose, landmarks_[landmark].first_pose);
  prior_.Merge(landmark, into);
  RefreezeAll();
}

void PoseLandmarkGraph::RemoveLandmark(size_t landmark) {
  for (PoseNode& pose : poses_) {
    std::erase_if(pose.sightings, [&](const Sighting& s) { return s.landmark == landmark; });
  }
  landmarks_.at(landmark).alive = false;
}

Pose2 PoseLandmarkGraph::pose(size_t number) const {
  const auto& x = poses_.at(number - first_pose_).x;
  return {x[0], x[1], WrapAngle(x[2])};
}

Eigen::Vector2d PoseLandmarkGraph::landmark(size_t number) const {
  const auto& x = landmarks_.at(number).x;
  return {x[0], x[1]};
}

bool PoseLandmarkGraph::MayHaveBeenSeenTogether(size_t a, size_t b) const {
  if (landmarks_.at(a).first_pose < first_pose_ && landmarks_.at(b).first_pose < first_pose_)
    return true;
  const auto sees = [](const PoseNode& pose, size_t landmark) {
    return std::any_of(pose.sightings.begin(), pose.sightings.end(),
                       [&](const Sighting& s) { return s.landmark == landmark; });
  };
  return std::any_of(poses_.begin(), poses_.end(),
                     [&](const PoseNode& pose) { return sees(pose, a) && sees(pose, b); });
}

double PoseLandmarkGraph::SquaredResidual(size_t landmark,
                                          const LandmarkMeasurement& measurement) const {
  Eigen::Vector2d r;
  LandmarkResidual(measurement, poses_.back().x.data(), landmarks_.at(landmark).x.data(), r.data(),
                   nullptr, nullptr);
  return r.squaredNorm();
}

std::optional<double> PoseLandmarkGraph::SightingRms(size_t landmark, size_t from) const {
  double sum = 0.0;
  int count = 0;
  for (size_t i = std::max(from, first_pose_); i < end_pose(); ++i) {
    for (const Sighting& sighting : poses_[i - first_pose_].sightings) {
      if (sighting.landmark != landmark) continue;
      const Eigen::Vector2d seen = pose(i) * sighting.measurement.position;
      sum += (seen - this->landmark(landmark)).squaredNorm();
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / count);
}

double PoseLandmarkGraph::Cost() const {
  double sum = 0.0;
  for (size_t i = 0; i < poses_.size(); ++i) {
    if (i > 0) {
      Eigen::Vector3d r;
      OdometryResidual(poses_[i].odometry, poses_[i - 1].x.data(), poses_[i].x.data(), r.data(),
                       nullptr, nullptr);
      sum += r.squaredNorm();
    }
    for (const Sighting& sighting : poses_[i].sightings) {
      Eigen::Vector2d r;
      LandmarkResidual(sighting.measurement, poses_[i].x.data(),
                       landmarks_[sighting.landmark].x.data(), r.data(), nullptr, nullptr);
      sum += r.squaredNorm();
    }
  }
  return 0.5 * sum;
}

double PoseLandmarkGraph::WeightOf(const PoseNode& pose, const Sighting& sighting) const {
  Eigen::Vector2d r;
  LandmarkResidual(sighting.measurement, pose.x.data(), landmarks_[sighting.landmark].x.data(),
                   r.data(), nullptr, nullptr);
  return CauchyWeight(r.squaredNorm(), params_.full.loss_scale);
}

void PoseLandmarkGraph::AddFrozen(const PoseNode& pose, const Sighting& sighting, double weight) {
  const Pose2 T_map_base{pose.x[0], pose.x[1], pose.x[2]};
  const Eigen::Matrix2d S =
      sighting.measurement.sqrt_information * T_map_base.rotation().transpose();
  const Eigen::Matrix2d information = weight * Eigen::Matrix2d(S.transpose() * S);
  LandmarkNode& landmark = landmarks_[sighting.landmark];
  landmark.frozen_information += information;
  landmark.frozen_vector += information * (T_map_base * sighting.measurement.position);
}

void PoseLandmarkGraph::Freeze(PoseNode& pose) {
  for (Sighting& sighting : pose.sightings) {
    sighting.frozen_weight = WeightOf(pose, sighting);
    AddFrozen(pose, sighting, sighting.frozen_weight);
  }
}

void PoseLandmarkGraph::Thaw(const PoseNode& pose) {
  for (const Sighting& sighting : pose.sightings)
    AddFrozen(pose, sighting, -sighting.frozen_weight);
}

void PoseLandmarkGraph::FreezeUpTo(size_t number) {
  for (; frozen_end_ < number; ++frozen_end_) Freeze(poses_[frozen_end_ - first_pose_]);
}

void PoseLandmarkGraph::RefreezeAll() {
  for (LandmarkNode& landmark : landmarks_) {
    landmark.frozen_information.setZero();
    landmark.frozen_vector.setZero();
  }
  const size_t end = frozen_end_;
  frozen_end_ = first_pose_;
  FreezeUpTo(std::max(end, first_pose_));
}

void PoseLandmarkGraph::MarginaliseOldest() {
  require(poses_.size() > 1, "the last pose cannot be marginalised");
  const PoseNode& oldest = poses_[0];
  if (frozen_end_ > first_pose_) {
    Thaw(oldest);
  } else {
    frozen_end_ = first_pose_ + 1;
  }
  std::vector<InformationPrior::Sighting> sightings;
  for (const Sighting& sighting : oldest.sightings) {
    sightings.push_back({sighting.landmark, &sighting.measurement,
                         landmarks_[sighting.landmark].x.data(), WeightOf(oldest, sighting)});
  }
  prior_.Marginalise(oldest.x.data(), poses_[1].x.data(), poses_[1].odometry, sightings);
  poses_.pop_front();
  ++first_pose_;
}

}  // namespace hairpin
