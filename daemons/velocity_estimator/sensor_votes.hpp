#pragma once

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

  /// Adds the readings of one step, seen against the state before any of them is fused.
  void Cast(const StateVector& state, const Readings& readings, const Wheels& slip_sigmas);
  std::optional<ConsistencyVote::Minority> SpeedMinorityAt(int64_t now) const {
    return speed_.MinorityAt(now);
  }
  std::optional<ConsistencyVote::Minority> YawRateMinorityAt(int64_t now) const {
    return yaw_rate_.MinorityAt(now);
  }

  enum SpeedVoter : size_t { kGroundSpeed, kWheels, kGnss, kNumSpeedVoters };
  enum YawVoter : size_t { kGyro, kLateralAcceleration, kRearWheels, kHeading, kNumYawVoters };

 private:
  void CastMotors(const StateVector& state, const Readings& readings, const Wheels& slip_sigmas);
  void CastGnss(const StateVector& state, const GnssReading& reading);
  void CastImu(const StateVector& state, const ImuReading& reading);

  VelocityEstimatorParams params_;
  ConsistencyVote speed_;
  ConsistencyVote yaw_rate_;
  std::optional<GnssReading> last_gnss_;
};

}  // namespace hairpin
