#include "daemons/global_mapper/factors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

namespace hairpin {
namespace {

template <class Matrix>
Matrix SqrtInformationOf(const Matrix& covariance) {
  const Eigen::LLT<Matrix> of_covariance(covariance);
  if (!covariance.allFinite() || of_covariance.info() != Eigen::Success)
    throw std::invalid_argument("global_mapper: covariance is not positive definite");
  const Matrix information = of_covariance.solve(Matrix::Identity());
  const Eigen::LLT<Matrix> of_information(0.5 * (information + information.transpose()));
  if (of_information.info() != Eigen::Success)
    throw std::invalid_argument("global_mapper: covariance is too ill-conditioned");
  return of_information.matrixU();
}

template <int rows, int cols>
using RowMajor = Eigen::Map<Eigen::Matrix<double, rows, cols, Eigen::RowMajor>>;

}  // namespace

Eigen::Matrix3d SqrtInformation(const Eigen::Matrix3d& covariance) {
  return SqrtInformationOf(covariance);
}

Eigen::Matrix2d SqrtInformation(const Eigen::Matrix2d& covariance) {
  return SqrtInformationOf(covariance);
}

void OdometryResidual(const OdometryMeasurement& measurement, const double* from, const double* to,
                      double* residual, double* by_from, double* by_to) {
  const double c = std::cos(from[2]);
  const double s = std::sin(from[2]);
  const double dx = to[0] - from[0];
  const double dy = to[1] - from[1];
  const double x = c * dx + s * dy;
  const double y = -s * dx + c * dy;
  const Eigen::Vector3d error(x - measurement.T_from_to.x, y - measurement.T_from_to.y,
                              WrapAngle(to[2] - from[2] - measurement.T_from_to.yaw));
  const Eigen::Matrix3d& S = measurement.sqrt_information;
  Eigen::Map<Eigen::Vector3d>(residual).noalias() = S * error;
  if (by_from != nullptr) {
    Eigen::Matrix3d J;
    J << -c, -s, y, s, -c, -x, 0.0, 0.0, -1.0;
    RowMajor<3, 3> out(by_from);
    out.noalias() = S * J;
  }
  if (by_to != nullptr) {
    Eigen::Matrix3d J;
    J << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
    RowMajor<3, 3> out(by_to);
    out.noalias() = S * J;
  }
}

Direction::Direction(double yaw) : cosine(std::cos(yaw)), sine(std::sin(yaw)) {}

void LandmarkResidual(const LandmarkMeasurement& measurement, const double* pose,
                      const double* landmark, double* residual, double* by_pose,
                      double* by_landmark) {
  LandmarkResidual(measurement, pose, Direction(pose[2]), landmark, residual, by_pose, by_landmark);
}

void LandmarkResidual(const LandmarkMeasurement& measurement, const double* pose,
                      const Direction& direction, const double* landmark, double* residual,
                      double* by_pose, double* by_landmark) {
  const double c = direction.cosine;
  const double s = direction.sine;
  const double dx = landmark[0] - pose[0];
  const double dy = landmark[1] - pose[1];
  const double x = c * dx + s * dy;
  const double y = -s * dx + c * dy;
  const Eigen::Vector2d error(x - measurement.position.x(), y - measurement.position.y());
  const Eigen::Matrix2d& S = measurement.sqrt_information;
  Eigen::Map<Eigen::Vector2d>(residual).noalias() = S * error;
  if (by_pose != nullptr) {
    Eigen::Matrix<double, 2, 3> J;
    J << -c, -s, y, s, -c, -x;
    RowMajor<2, 3> out(by_pose);
    out.noalias() = S * J;
  }
  if (by_landmark != nullptr) {
    Eigen::Matrix2d J;
    J << c, s, -s, c;
    RowMajor<2, 2> out(by_landmark);
    out.noalias() = S * J;
  }
}

double CauchyWeight(double squared_residual, double scale) {
  return scale <= 0.0 ? 1.0 : 1.0 / (1.0 + squared_residual / (scale * scale));
}

}  // namespace hairpin
