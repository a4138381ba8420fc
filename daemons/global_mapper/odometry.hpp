#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>

#include "common/geometry.hpp"
#include "common/pose_history.hpp"

namespace hairpin {

/// A motion in the frame of its start, with the covariance of (x, y, yaw).
struct Motion {
  Pose2 T_from_to;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

struct OdometryParams {
  double history = 0.0;         // s of velocity kept, > 0
  double error_time = 0.0;      // s, > 0: how long an error of VELOCITY lasts
  double position_sigma = 0.0;  // m per sqrt(m) driven, >= 0: what VELOCITY's covariance leaves out
  double yaw_sigma = 0.0;       // rad per sqrt(m), >= 0
  double min_position_sigma = 0.0;  // m of any motion, > 0
  double min_yaw_sigma = 0.0;       // rad, > 0
  double gap_acceleration =
      0.0;  // m/s^2, change of acceleration that a gap of VELOCITY may hide, >= 0
  double gap_yaw_acceleration = 0.0;  // rad/s^2, >= 0

  /// Throws std::invalid_argument naming parameter, relation and bound.
  void Validate() const;
};

/// The covariance that `motion` (of a car that drove `distance` [m]) has without anything known of
/// its velocities: the params' growth by distance, and the floor.
Eigen::Matrix3d CovarianceByDistance(const OdometryParams& params, const Pose2& motion);

/// Integrates VELOCITY and its covariance between any two times of the last seconds. An error of
/// the velocity is taken to last `error_time`: a sample of dt counts with dt * 2 error_time of its
/// covariance, the variance of an integrated first-order Gauss-Markov process over times much
/// longer.
class VelocityOdometry {
 public:
  explicit VelocityOdometry(const OdometryParams& params);

  /// Returns why it was refused, empty if it was not.
  std::string_view Add(int64_t utime, const Twist2& velocity, const Eigen::Matrix3d& covariance);

  /// Empty where a time is not within the history (or up to 0.1 s past it), or `to` is before
  /// `from`.
  std::optional<Motion> Between(int64_t from_utime, int64_t to_utime) const;
  /// Of a motion that took `seconds` and is known from elsewhere, where its velocities were not
  /// heard: as if all of it had been like the newest one.
  Eigen::Matrix3d CovarianceOf(const Pose2& motion, double seconds) const;

 private:
  struct Sample {
    int64_t utime;
    double yaw_rate;
    Eigen::Matrix3d covariance;  // of (vx, vy, yaw rate)
    double dt;                   // s since the sample before
  };
  OdometryParams params_;
  PoseHistory poses_;
  std::deque<Sample> samples_;
};

}  // namespace hairpin
