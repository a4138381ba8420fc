#include "daemons/global_mapper/pose_landmark_graph.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "daemons/global_mapper/require.hpp"

namespace hairpin {
namespace {

constexpr double kAnchorVariance = 1e-8;  // m^2, rad^2: where the first pose is, is a definition

}  // namespace

void GraphParams::Validate() const {
  for (const SolverParams* solver : {&window, &full}) {
    RequireGlobalMap(solver->max_iterations > 0, "max_iterations must be > 0");
    RequireGlobalMap(solver->loss_scale >= 0.0, "loss_scale must be >= 0");
    RequireGlobalMap(solver->tolerance > 0.0, "tolerance must be > 0");
  }
  RequireGlobalMap(window_poses > 1, "window_poses must be > 1");
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
  RequireGlobalMap(landmark < landmarks_.size() && landmarks_[landmark].alive,
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

PoseLandmarkGraph::Values PoseLandmarkGraph::Save() const {
  Values values;
  for (const PoseNode& pose : poses_) values.poses.push_back(pose.x);
  for (const LandmarkNode& landmark : landmarks_) values.landmarks.push_back(landmark.x);
  return values;
}

void PoseLandmarkGraph::Restore(const Values& values) {
  for (size_t i = 0; i < poses_.size(); ++i) poses_[i].x = values.poses[i];
  for (size_t i = 0; i < landmarks_.size(); ++i) landmarks_[i].x = values.landmarks[i];
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

void PoseLandmarkGraph::AddTerms(size_t from, LeastSquaresProblem& problem) {
  for (size_t i = from - first_pose_; i < poses_.size(); ++i) {
    PoseNode& pose = poses_[i];
    if (i > 0) problem.odometry.push_back({poses_[i - 1].x.data(), pose.x.data(), &pose.odometry});
    for (const Sighting& sighting : pose.sightings) {
      problem.sightings.push_back(
          {pose.x.data(), landmarks_[sighting.landmark].x.data(), &sighting.measurement});
    }
  }
}

std::vector<size_t> PoseLandmarkGraph::SeenFrom(size_t from) const {
  std::set<size_t> seen;
  for (size_t i = from; i < end_pose(); ++i) {
    for (const Sighting& sighting : poses_[i - first_pose_].sightings)
      seen.insert(sighting.landmark);
  }
  return {seen.begin(), seen.end()};
}

void PoseLandmarkGraph::AddPrior(const InformationPrior::Quadratic& cost, bool with_pose,
                                 const std::vector<size_t>& landmarks,
                                 LeastSquaresProblem& problem) {
  problem.dense_mean = cost.mean;
  problem.dense_sqrt_information = Eigen::LLT<Eigen::MatrixXd>(cost.information).matrixU();
  if (with_pose) {
    problem.dense_blocks.push_back(poses_.front().x.data());
    problem.dense_sizes.push_back(3);
  }
  for (const size_t landmark : landmarks) {
    problem.dense_blocks.push_back(landmarks_[landmark].x.data());
    problem.dense_sizes.push_back(2);
  }
}

bool PoseLandmarkGraph::Run(LeastSquaresProblem& problem, const SolverParams& params) {
  const Values before = Save();
  bool good = Solve(problem, params);
  for (const PoseNode& pose : poses_) {
    good = good && std::isfinite(pose.x[0] + pose.x[1] + pose.x[2]);
  }
  for (const LandmarkNode& landmark : landmarks_) {
    good = good && std::isfinite(landmark.x[0] + landmark.x[1]);
  }
  if (!good) Restore(before);
  return good;
}

bool PoseLandmarkGraph::SolveWindow() {
  if (poses_.size() <= params_.window_poses) return SolveAll();
  const size_t from = end_pose() - params_.window_poses;
  FreezeUpTo(from);
  LeastSquaresProblem problem;
  AddTerms(from, problem);
  problem.constant.push_back(poses_[from - 1 - first_pose_].x.data());
  std::vector<size_t> seen = SeenFrom(from);
  for (const size_t number : seen) {
    LandmarkNode& landmark = landmarks_[number];
    const Eigen::LLT<Eigen::Matrix2d> factor(landmark.frozen_information);
    if (landmark.frozen_information.isZero() || factor.info() != Eigen::Success) continue;
    problem.unaries.push_back(
        {landmark.x.data(), factor.solve(landmark.frozen_vector), factor.matrixU()});
  }
  std::erase_if(seen, [this](size_t landmark) { return !prior_.Knows(landmark); });
  if (!seen.empty()) {
    const auto cost = prior_.Condition(seen, poses_.front().x.data(), [this](size_t landmark) {
      return landmarks_[landmark].x.data();
    });
    if (cost) AddPrior(*cost, false, seen, problem);
  }
  return Run(problem, params_.window);
}

void PoseLandmarkGraph::MoveUnseen(const InformationPrior::Marginal& prior,
                                   const std::vector<size_t>& seen) {
  Eigen::VectorXd moved = -prior.cost.mean;
  moved.head<3>() += Eigen::Map<const Eigen::Vector3d>(poses_.front().x.data());
  Eigen::Index row = 3;
  for (const size_t landmark : seen) {
    moved.segment<2>(row) += Eigen::Map<const Eigen::Vector2d>(landmarks_[landmark].x.data());
    row += 2;
  }
  const Eigen::VectorXd others = prior.mean - prior.gain * moved;
  row = 0;
  for (const size_t landmark : prior.others) {
    landmarks_[landmark].x = {others[row], others[row + 1]};
    row += 2;
  }
}

bool PoseLandmarkGraph::SolveAll() { return SolveAll(params_.full); }

bool PoseLandmarkGraph::SolveAllTrustingSightings() {
  SolverParams params = params_.full;
  params.loss_scale = 0.0;
  return SolveAll(params);
}

bool PoseLandmarkGraph::SolveAll(const SolverParams& params) {
  LeastSquaresProblem problem;
  AddTerms(first_pose_, problem);
  // What no pose of the graph sees follows what they do see: Ceres need not know of it.
  std::vector<size_t> seen = SeenFrom(first_pose_);
  std::erase_if(seen, [this](size_t landmark) { return !prior_.Knows(landmark); });
  const auto prior = prior_.Marginalised(seen);
  if (!prior) return false;
  AddPrior(prior->cost, true, seen, problem);
  const bool good = Run(problem, params);
  if (good) MoveUnseen(*prior, seen);
  RefreezeAll();
  return good;
}

void PoseLandmarkGraph::MarginaliseOldest() {
  RequireGlobalMap(poses_.size() > 1, "the last pose cannot be marginalised");
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
