#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "daemons/velocity_estimator/consistency_vote.hpp"
#include "daemons/velocity_estimator/measurements.hpp"
#include "daemons/velocity_estimator/motion_model.hpp"
#include "daemons/velocity_estimator/velocity_estimator_params.hpp"

namespace hairpin {

/// Two votes among the sensors: on forward speed (optical, wheels, GNSS), and on yaw rate (gyro,
/// lateral acceleration over speed, the rear wheels' difference, the change of GNSS heading). Finds
/// the slow drift that gates cannot see.
class SensorVotes {
 public:
  explicit SensorVotes(const VelocityEstimatorParams& params);

  /// Adds the readings of one step, seen against the state of `utime` before any of them is fused;
  /// `wheels` as they are turned.
  void Cast(int64_t utime, const StateVector& state, const Readings& readings,
            const std::array<WheelGeometry, 4>& wheels, const Wheels& slip_sigmas);
  const ConsistencyVote& forward() const { return forward_; }
  const ConsistencyVote& lateral() const { return lateral_; }
  const ConsistencyVote& yaw_rate() const { return yaw_rate_; }

  enum SpeedVoter : size_t { kGroundSpeed, kWheels, kGnss, kNumSpeedVoters };
  enum YawVoter : size_t { kGyro, kLateralAcceleration, kHeading, kNumYawVoters };

 private:
  double SpeedTolerance(double speed) const;
  void CastMotors(const StateVector& state, const MotorsReading& reading,
                  const std::array<WheelGeometry, 4>& wheels, const Wheels& slip_sigmas);
  void CastGroundSpeed(const StateVector& state, const GroundSpeedReading& reading);
  void CastGnss(const StateVector& state, const GnssReading& reading);
  void CastImu(const StateVector& state, const ImuReading& reading);

  VelocityEstimatorParams params_;
  ConsistencyVote forward_;
  ConsistencyVote lateral_;
  ConsistencyVote yaw_rate_;
  std::optional<GnssReading> last_gnss_;
  double turned_ = 0.0;  // rad since the last GNSS reading, by the filter
  int64_t utime_ = 0;
};

}  // namespace hairpin
