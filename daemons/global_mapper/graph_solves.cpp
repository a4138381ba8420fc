#include <Eigen/Cholesky>
#include <cmath>
#include <set>

#include "daemons/global_mapper/pose_landmark_graph.hpp"

namespace hairpin {

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
  const std::vector<size_t> seen = SeenFrom(from);
  for (const size_t number : seen) {
    LandmarkNode& landmark = landmarks_[number];
    const Eigen::LLT<Eigen::Matrix2d> factor(landmark.frozen_information);
    if (landmark.frozen_information.isZero() || factor.info() != Eigen::Success) continue;
    problem.unaries.push_back(
        {landmark.x.data(), factor.solve(landmark.frozen_vector), factor.matrixU()});
  }
  const std::vector<size_t> known = prior_.KnownAmong(seen);
  if (!known.empty()) {
    const auto cost = prior_.Condition(known, poses_.front().x.data(), [this](size_t landmark) {
      return landmarks_[landmark].x.data();
    });
    if (cost) AddPrior(*cost, false, known, problem);
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
  const std::vector<size_t> known = prior_.KnownAmong(SeenFrom(first_pose_));
  const auto prior = prior_.Marginalised(known);
  if (!prior) return false;
  AddPrior(prior->cost, true, known, problem);
  const bool good = Run(problem, params);
  if (good) MoveUnseen(*prior, known);
  RefreezeAll();
  return good;
}

}  // namespace hairpin
