#include "daemons/global_mapper/odometry.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/clock.hpp"
#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr Require require("global_mapper");

constexpr double kGap = 0.1;  // s: a longer interval between velocities is a gap

/// How an error of the pose at the start of a step of `offset` moves its end, all in the first
/// frame.
Eigen::Matrix3d Lever(const Eigen::Vector2d& offset) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 2) = -offset.y();
  F(1, 2) = offset.x();
  return F;
}

bool IsSound(const Eigen::Matrix3d& covariance) {
  return covariance.allFinite() &&
         Eigen::LLT<Eigen::Matrix3d>(covariance + 1e-12 * Eigen::Matrix3d::Identity()).info() ==
             Eigen::Success;
}

}  // namespace

void OdometryParams::Validate() const {
  require(history > 0.0, "history must be > 0");
  require(error_time > 0.0, "velocity_error_time must be > 0");
  require(position_sigma >= 0.0, "odometry position_sigma must be >= 0");
  require(yaw_sigma >= 0.0, "odometry yaw_sigma must be >= 0");
  require(min_position_sigma > 0.0, "odometry min_position_sigma must be > 0");
  require(min_yaw_sigma > 0.0, "odometry min_yaw_sigma must be > 0");
  require(gap_acceleration >= 0.0, "gap_acceleration must be >= 0");
  require(gap_yaw_acceleration >= 0.0, "gap_yaw_acceleration must be >= 0");
}

Eigen::Matrix3d CovarianceByDistance(const OdometryParams& params, const Pose2& motion) {
  const double distance = motion.position().norm();
  const double position =
      std::pow(params.min_position_sigma, 2) + std::pow(params.position_sigma, 2) * distance;
  const double yaw = std::pow(params.min_yaw_sigma, 2) + std::pow(params.yaw_sigma, 2) * distance;
  return Eigen::Vector3d(position, position, yaw).asDiagonal();
}

VelocityOdometry::VelocityOdometry(const OdometryParams& params)
    : params_(params), poses_(params.history) {
  params.Validate();
}

std::string_view VelocityOdometry::Add(int64_t utime, const Twist2& velocity,
                                       const Eigen::Matrix3d& covariance) {
  if (!IsSound(covariance)) return "covariance is not positive definite";
  const int64_t before = poses_.empty() ? utime : poses_.newest_utime();
  if (!poses_.Add(utime, velocity)) return "time does not increase";
  samples_.push_back({utime, velocity.yaw_rate, covariance, SecondsBetween(before, utime)});
  while (SecondsBetween(samples_.front().utime, utime) > params_.history) samples_.pop_front();
  return {};
}

std::optional<Motion> VelocityOdometry::Between(int64_t from_utime, int64_t to_utime) const {
  if (to_utime < from_utime) return std::nullopt;
  const auto start = poses_.At(from_utime);
  const auto end = poses_.At(to_utime);
  if (!start || !end) return std::nullopt;
  Motion motion;
  motion.T_from_to = start->Inverse() * *end;
  Pose2 reached;
  double driven = 0.0;
  for (const Sample& sample : samples_) {
    if (sample.utime <= from_utime) continue;
    const int64_t until = std::min(sample.utime, to_utime);
    const double dt = std::min(sample.dt, SecondsBetween(from_utime, until));
    const Pose2 next = start->Inverse() * *poses_.At(until);
    const Eigen::Vector2d step = next.position() - reached.position();
    const Eigen::Matrix3d F = Lever(step);
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    G.topLeftCorner<2, 2>() = reached.rotation();
    Eigen::Matrix3d Q = dt * 2.0 * params_.error_time * sample.covariance;
    if (sample.dt > kGap) {
      const double hidden = sample.dt * sample.dt / 12.0;
      Q(0, 0) += std::pow(hidden * params_.gap_acceleration, 2);
      Q(1, 1) += std::pow(hidden * params_.gap_acceleration, 2);
      Q(2, 2) += std::pow(hidden * params_.gap_yaw_acceleration, 2);
    }
    motion.covariance = F * motion.covariance * F.transpose() + G * Q * G.transpose();
    driven += step.norm();
    reached = next;
    if (sample.utime >= to_utime) break;
  }
  motion.covariance += CovarianceByDistance(params_, {driven, 0.0, 0.0});
  return motion;
}

Eigen::Matrix3d VelocityOdometry::CovarianceOf(const Pose2& motion, double seconds) const {
  Eigen::Matrix3d covariance = CovarianceByDistance(params_, motion);
  if (samples_.empty()) return covariance;
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G.topLeftCorner<2, 2>() = Pose2{0.0, 0.0, 0.5 * motion.yaw}.rotation();
  const Eigen::Matrix3d Q =
      seconds * 2.0 * params_.error_time * G * samples_.back().covariance * G.transpose();
  // Errors come evenly along a straight way: the integral of F Q F^T, F being the lever to its end.
  const Eigen::Matrix3d J = Lever(motion.position()) - Eigen::Matrix3d::Identity();
  covariance += Q + (J * Q + Q * J.transpose()) / 2.0 + J * Q * J.transpose() / 3.0;
  return covariance;
}

}  // namespace hairpin
