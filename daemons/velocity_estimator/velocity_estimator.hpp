#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>

#include "common/geometry.hpp"
#include "daemons/velocity_estimator/measurements.hpp"
#include "daemons/velocity_estimator/standstill.hpp"
#include "daemons/velocity_estimator/velocity_estimator_params.hpp"
#include "daemons/velocity_estimator/velocity_filter.hpp"

namespace hairpin {

/// Whether a reading was taken, and if not, why.
enum class Intake { kTaken, kTimeNotIncreasing, kTooOld, kTooFarAhead };
std::string_view NameOf(Intake intake);

struct VelocityEstimate {
  int64_t utime = 0;
  bool valid = false;
  Twist2 velocity;                                           // of base, in base
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  // of vx, vy, yaw rate; SI
  Eigen::Vector2d acceleration = Eigen::Vector2d::Zero();    // base [m/s^2]
  Wheels slip{};
  SensorStates states;
  InnovationStatistics innovations;
};

/// Velocity of the car from all sensors that tell of it. Source: [paper III], PAPER_NOTES "Velocity
/// estimation".
///
/// Readings wait, the newest of each sensor, until `Advance()` predicts to a time and fuses them in
/// a fixed order; so the result does not depend on the order in which they came. A reading whose
/// time differs from the filter's is compared with the state moved to its own time.
class VelocityEstimator {
 public:
  /// Throws std::invalid_argument for parameters that cannot be.
  explicit VelocityEstimator(const VelocityEstimatorParams& params);

  /// Takes a reading unless its sensor's time does not increase, it is more than `max_age` behind
  /// the filter, or more than `max_gap` ahead of it. Readings that go on ahead of the filter with
  /// nothing else between are believed in the end.
  Intake Add(const ImuReading& reading);
  Intake Add(const GroundSpeedReading& reading);
  Intake Add(const MotorsReading& reading);
  Intake Add(const SteeringReading& reading);
  Intake Add(const GnssReading& reading);

  /// True if the IMU has been silent past its deadline at `utime`, so that another sensor must lead
  /// the filter.
  bool IsImuSilentAt(int64_t utime) const;

  /// Moves to `utime` and fuses what waits. Throws std::invalid_argument unless `utime` increases.
  VelocityEstimate Advance(int64_t utime);

  /// Time of the last `Advance()`; empty before the first.
  std::optional<int64_t> utime() const { return utime_; }
  /// Learnt at standstill [rad/s].
  double gyro_bias() const { return standstill_.gyro_bias(); }

 private:
  template <class Reading>
  struct Inbox {
    std::optional<Reading> waiting;
    std::optional<int64_t> last_utime;
  };

  template <class Reading>
  Intake Take(const Reading& reading, Inbox<Reading>& inbox);
  bool BelievesJump(int64_t utime);
  template <class Reading>
  std::optional<Reading> Collect(Inbox<Reading>& inbox) const;
  Readings CollectAll();
  void FuseStandstill(const ImuReading& imu, double dt);
  bool IsLost() const;
  VelocityEstimate Estimate() const;

  VelocityEstimatorParams params_;
  VelocityFilter filter_;
  Standstill standstill_;
  Inbox<ImuReading> imu_;
  Inbox<GroundSpeedReading> ground_speed_;
  Inbox<MotorsReading> motors_;
  Inbox<SteeringReading> steering_;
  Inbox<GnssReading> gnss_;
  std::optional<MotorsReading> last_motors_;
  std::optional<GroundSpeedReading> last_ground_speed_;
  std::optional<SteeringReading> last_steering_;
  std::optional<int64_t> utime_;
  std::optional<int64_t> first_utime_;  // heard of anything
  int ahead_in_a_row_ = 0;
  int64_t ahead_utime_ = 0;
};

}  // namespace hairpin
