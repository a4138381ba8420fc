#include "common/geometry.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace hairpin {

double WrapAngle(double angle) {
  constexpr double kPi = std::numbers::pi;
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

Eigen::Matrix2d Pose2::rotation() const {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  Eigen::Matrix2d rotation;
  rotation << c, -s, s, c;
  return rotation;
}

Pose2 Pose2::Inverse() const {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return {-c * x - s * y, s * x - c * y, WrapAngle(-yaw)};
}

Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) {
  const Eigen::Vector2d position_a = T_a_b * T_b_c.position();
  return {position_a.x(), position_a.y(), WrapAngle(T_a_b.yaw + T_b_c.yaw)};
}

Eigen::Vector2d operator*(const Pose2& T_a_b, const Eigen::Vector2d& point_b) {
  const double c = std::cos(T_a_b.yaw);
  const double s = std::sin(T_a_b.yaw);
  return {T_a_b.x + c * point_b.x() - s * point_b.y(), T_a_b.y + s * point_b.x() + c * point_b.y()};
}

Pose2 Integrate(const Twist2& velocity, double duration) {
  const double angle = velocity.yaw_rate * duration;
  // sin(a)/a and (1 - cos(a))/a, by their series where the quotients lose digits.
  const bool small = std::abs(angle) < 1e-4;
  const double sinc = small ? 1.0 - angle * angle / 6.0 : std::sin(angle) / angle;
  const double cosc = small ? angle / 2.0 : (1.0 - std::cos(angle)) / angle;
  const double dx = velocity.vx * duration;
  const double dy = velocity.vy * duration;
  return {sinc * dx - cosc * dy, cosc * dx + sinc * dy, WrapAngle(angle)};
}

Eigen::Matrix2d RotateCovariance(const Eigen::Matrix2d& covariance, double yaw) {
  const Eigen::Matrix2d rotation = Pose2{0.0, 0.0, yaw}.rotation();
  return rotation * covariance * rotation.transpose();
}

bool IsCovariance(const Eigen::Matrix2d& matrix) {
  if (!matrix.allFinite()) return false;
  const double scale = matrix.cwiseAbs().maxCoeff();
  if (std::abs(matrix(0, 1) - matrix(1, 0)) > 1e-9 * scale) return false;
  return matrix(0, 0) > 0.0 && matrix(1, 1) > 0.0 && matrix.determinant() > 1e-12 * scale * scale;
}

}  // namespace hairpin
