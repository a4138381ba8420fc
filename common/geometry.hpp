#pragma once

#include <Eigen/Core>

namespace hairpin {

/// The same angle in (-pi, pi] [rad]. Any finite input.
double WrapAngle(double angle);

/// A pose or rigid transform in the plane. `T_local_base` takes base coordinates to local
/// coordinates: `point_local = T_local_base * point_base`. Positions in m, yaw counter-clockwise in
/// rad, kept in (-pi, pi].
struct Pose2 {
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;

  Eigen::Vector2d position() const { return {x, y}; }
  /// 2x2 rotation by yaw.
  Eigen::Matrix2d rotation() const;
  Pose2 Inverse() const;
};

/// Composition: T_a_c = T_a_b * T_b_c.
Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c);
/// point_a = T_a_b * point_b.
Eigen::Vector2d operator*(const Pose2& T_a_b, const Eigen::Vector2d& point_b);

/// Planar velocity of base, in base: forward, left [m/s], counter-clockwise [rad/s].
struct Twist2 {
  double vx = 0.0;
  double vy = 0.0;
  double yaw_rate = 0.0;
};

/// T_start_end of a body that moves with constant `velocity` for `duration` [s]: the exponential
/// map of SE(2). Exact for constant velocity, stable for a yaw rate near zero; negative durations
/// go back in time.
Pose2 Integrate(const Twist2& velocity, double duration);

/// Covariance turned by yaw: R P R^T.
Eigen::Matrix2d RotateCovariance(const Eigen::Matrix2d& covariance, double yaw);

/// True if finite, symmetric within rounding and positive definite.
bool IsCovariance(const Eigen::Matrix2d& matrix);

}  // namespace hairpin
