#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "daemons/velocity_estimator/measurements.hpp"
#include "daemons/velocity_estimator/motion_model.hpp"
#include "daemons/velocity_estimator/sensor_monitor.hpp"
#include "daemons/velocity_estimator/sensor_votes.hpp"
#include "daemons/velocity_estimator/unscented_filter.hpp"
#include "daemons/velocity_estimator/velocity_estimator_params.hpp"

namespace hairpin {

struct SensorStates {
  SensorState gyro = SensorState::kSilent;
  SensorState accelerometer = SensorState::kSilent;
  SensorState ground_speed = SensorState::kSilent;
  SensorState motors = SensorState::kSilent;  // rejected where fewer than two wheels are in use
  SensorState gnss = SensorState::kSilent;
};

/// Normalised innovations squared, y^T S^-1 y, of the readings of one step, used or not; empty
/// where there was none. Chi-square of one degree of freedom (gyro, each wheel) or two.
struct InnovationStatistics {
  std::optional<double> gyro;
  std::optional<double> accelerometer;
  std::optional<double> ground_speed;
  std::array<std::optional<double>, 4> wheels;
  std::optional<double> gnss;
};

/// The unscented Kalman filter of the car's velocity: prediction, the measurement of each sensor
/// with its lever arm, the chi-square gates, and the sensors' states. Source: PAPER_NOTES,
/// "Velocity estimation".
class VelocityFilter {
 public:
  explicit VelocityFilter(const VelocityEstimatorParams& params);

  /// Knows nothing from now on, at `utime`, and believes every sensor again.
  void Restart(int64_t utime);

  /// Predicts to `utime`, which must not be before the last.
  void PredictTo(int64_t utime);

  /// Fuses readings in a fixed order: gyro, accelerometer, optical, wheels, GNSS. IMU readings come
  /// without bias.
  void Fuse(const Readings& readings);

  /// The car stands: v = 0, r = 0. Gated like a sensor; returns whether the filter agreed.
  bool FuseStandstill();

  const StateVector& mean() const { return filter_.mean(); }
  const StateMatrix& covariance() const { return filter_.covariance(); }
  /// Largest standard deviation of the velocity in any direction along an axis [m/s].
  double velocity_sigma() const;
  double yaw_rate_sigma() const;
  bool IsCertain() const;
  SensorStates StatesAt(int64_t utime) const;
  /// Of the last `Fuse()`.
  const InnovationStatistics& innovations() const { return innovations_; }

  static constexpr double kPriorVelocitySigma = 20.0;  // m/s: any speed this car reaches

 private:
  template <int M, class Model>
  double FuseGated(SensorMonitor& monitor, int64_t utime,
                   const Eigen::Matrix<double, M, 1>& measured, const Model& model,
                   const Eigen::Matrix<double, M, M>& noise, bool is_possible = true);
  void FuseImu(const ImuReading& reading);
  void FuseGroundSpeed(const GroundSpeedReading& reading);
  void FuseMotors(const MotorsReading& reading, const std::optional<SteeringReading>& steering);
  void FuseWheel(size_t index, const MotorsReading& reading, const WheelGeometry& wheel,
                 double steering_sigma);
  void FuseGnss(const GnssReading& reading);
  void FuseSteering(const SteeringReading& reading);
  void FuseRearAxle();
  std::array<WheelGeometry, 4> WheelsAt(const std::optional<SteeringReading>& steering) const;
  void FollowMajorities();
  bool Overrule(std::span<const std::span<SensorMonitor>> voters, size_t minority);
  bool IsSlipPossible(const WheelGeometry& wheel, double rolling_speed, double slip_sigma) const;
  void NoteMotion(const Readings& readings);
  SensorState MotorsStateAt(int64_t utime) const;

  VelocityEstimatorParams params_;
  SlipModel slip_model_;
  UnscentedFilter<kStateSize> filter_;
  SensorVotes votes_;
  SensorMonitor gyro_;
  SensorMonitor accelerometer_;
  SensorMonitor ground_speed_;
  SensorMonitor gnss_;
  std::array<SensorMonitor, 4> wheels_;
  InnovationStatistics innovations_;
  int64_t utime_ = 0;
  double step_ = 0.0;  // s, of the last prediction
  std::optional<Wheels> torque_;
  bool is_moving_ = false;
};

}  // namespace hairpin
