#include "daemons/local_mapper/pose_refinement.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace hairpin {
namespace {

constexpr int kIterations = 3;
constexpr double kCauchyChi2 =
    4.0;  // of a pair, whose weight is halved there: it may be a wrong one

/// How a point of base moves in local, by the pose's (x, y, yaw) in base.
Eigen::Matrix<double, 2, 3> PointJacobian(const Pose2& T_local_base, const Eigen::Vector2d& point) {
  Eigen::Matrix<double, 2, 3> J;
  J << 1.0, 0.0, -point.y(), 0.0, 1.0, point.x();
  return T_local_base.rotation() * J;
}

}  // namespace

Eigen::Matrix3d MotionCovariance(const PoseRefinementParams& params, double duration,
                                 const Twist2& change) {
  const double position = std::hypot(params.velocity_sigma * duration,
                                     params.stamp_sigma * std::hypot(change.vx, change.vy));
  const double yaw =
      std::hypot(params.yaw_rate_sigma * duration, params.stamp_sigma * change.yaw_rate);
  return Eigen::Vector3d(position, position, yaw).cwiseAbs2().asDiagonal();
}

Pose2 RefinePose(const std::vector<Gaussian2>& cones, const std::vector<ConeObservation>& seen,
                 double position_weight, const Pose2& predicted, const Eigen::Matrix3d& covariance,
                 const AssociationParams& association, size_t min_pairs) {
  const Eigen::Matrix3d prior = covariance.inverse();
  const Eigen::Matrix2d unmodelled =
      association.gate_sigma * association.gate_sigma * Eigen::Matrix2d::Identity();
  Pose2 pose = predicted;
  Eigen::Matrix3d uncertain = covariance;
  for (int i = 0; i < kIterations; ++i) {
    std::vector<Gaussian2> observations;  // local, as uncertain as the pose makes them
    observations.reserve(seen.size());
    for (const ConeObservation& cone : seen) {
      const auto J = PointJacobian(pose, cone.position);
      observations.push_back(
          {pose * cone.position, RotateCovariance(cone.covariance, pose.yaw) / position_weight +
                                     J * uncertain * J.transpose()});
    }
    const auto partner_of = Associate(cones, observations, association);
    const Pose2 from_predicted = predicted.Inverse() * pose;
    const Eigen::Vector3d offset(from_predicted.x, from_predicted.y, from_predicted.yaw);
    Eigen::Matrix3d information = prior;
    Eigen::Vector3d gradient = -prior * offset;
    size_t pairs = 0;
    for (size_t s = 0; s < seen.size(); ++s) {
      if (!partner_of[s]) continue;
      ++pairs;
      const Gaussian2& cone = cones[*partner_of[s]];
      const auto J = PointJacobian(pose, seen[s].position);
      const Eigen::Vector2d residual = cone.mean - observations[s].mean;
      Eigen::Matrix2d weight =
          (cone.covariance + RotateCovariance(seen[s].covariance, pose.yaw) / position_weight +
           unmodelled)
              .inverse();
      weight /= 1.0 + residual.dot(weight * residual) / kCauchyChi2;
      information += J.transpose() * weight * J;
      gradient += J.transpose() * weight * residual;
    }
    if (pairs < min_pairs) return predicted;
    const Eigen::Vector3d step = information.ldlt().solve(gradient);
    pose = pose * Pose2{step.x(), step.y(), step.z()};
    uncertain = information.inverse();
  }
  return pose;
}

}  // namespace hairpin
