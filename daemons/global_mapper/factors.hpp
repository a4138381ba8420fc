#pragma once

#include <Eigen/Core>

#include "common/geometry.hpp"

namespace hairpin {

/// S with r = S e and r^T r = e^T P^-1 e: S = L^T, where P^-1 = L L^T. (L e itself would be right
/// for diagonal covariances only.) Throws std::invalid_argument where P is not positive definite.
Eigen::Matrix3d SqrtInformation(const Eigen::Matrix3d& covariance);
Eigen::Matrix2d SqrtInformation(const Eigen::Matrix2d& covariance);

/// Motion between two poses, in the first: T_from_to and its square-root information.
struct OdometryMeasurement {
  Pose2 T_from_to;
  Eigen::Matrix3d sqrt_information = Eigen::Matrix3d::Identity();  // of (x, y, yaw)
};

/// A landmark in base of a pose.
struct LandmarkMeasurement {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // m
  Eigen::Matrix2d sqrt_information = Eigen::Matrix2d::Identity();
};

// Poses are (x, y, yaw), landmarks (x, y), both in map. The yaw need not be wrapped. Jacobians are
// row-major and may be null. [Grisetti 2010, "A Tutorial on Graph-Based SLAM"]

/// r = S [R(yaw_i)^T (p_j - p_i) - t_ij; wrap(yaw_j - yaw_i - yaw_ij)].
void OdometryResidual(const OdometryMeasurement& measurement, const double* from, const double* to,
                      double* residual, double* by_from, double* by_to);

/// Of a yaw.
struct Direction {
  explicit Direction(double yaw);
  double cosine;
  double sine;
};

/// r = S [R(yaw)^T (l - p) - z].
void LandmarkResidual(const LandmarkMeasurement& measurement, const double* pose,
                      const double* landmark, double* residual, double* by_pose,
                      double* by_landmark);
/// The same where the direction of the pose's yaw is known already.
void LandmarkResidual(const LandmarkMeasurement& measurement, const double* pose,
                      const Direction& direction, const double* landmark, double* residual,
                      double* by_pose, double* by_landmark);

/// Cauchy's loss rho(s) = c^2 ln(1 + s / c^2) of a squared residual; its slope is the weight that
/// the residual keeps. c = 0: no loss, slope 1.
double CauchyWeight(double squared_residual, double scale);

}  // namespace hairpin
