#include "daemons/velocity_estimator/velocity_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/clock.hpp"

namespace hairpin {
namespace {

constexpr int kReadingsToBelieveAJump = 10;  // two to three periods of all sensors together

const VelocityEstimatorParams& Checked(const VelocityEstimatorParams& params) {
  Validate(params);
  return params;
}

}  // namespace

std::string_view NameOf(Intake intake) {
  switch (intake) {
    case Intake::kTaken:
      return "taken";
    case Intake::kTimeNotIncreasing:
      return "time does not increase";
    case Intake::kTooOld:
      return "too old for the filter";
    case Intake::kTooFarAhead:
      return "too far ahead of the filter";
  }
  return "unknown";
}

VelocityEstimator::VelocityEstimator(const VelocityEstimatorParams& params)
    : params_(Checked(params)), filter_(params), standstill_(params.standstill) {}

template <class Reading>
Intake VelocityEstimator::Take(const Reading& reading, Inbox<Reading>& inbox) {
  if (inbox.last_utime && reading.utime <= *inbox.last_utime) return Intake::kTimeNotIncreasing;
  if (utime_) {
    const double ahead = SecondsBetween(*utime_, reading.utime);
    if (ahead < -params_.max_age) return Intake::kTooOld;
    if (ahead > params_.max_gap && !BelievesJump(reading.utime)) return Intake::kTooFarAhead;
    if (ahead <= params_.max_gap) ahead_in_a_row_ = 0;
  }
  if (!first_utime_) first_utime_ = reading.utime;
  inbox.last_utime = reading.utime;
  inbox.waiting = reading;
  return Intake::kTaken;
}

Intake VelocityEstimator::Add(const ImuReading& reading) { return Take(reading, imu_); }
Intake VelocityEstimator::Add(const GroundSpeedReading& reading) {
  return Take(reading, ground_speed_);
}
Intake VelocityEstimator::Add(const MotorsReading& reading) { return Take(reading, motors_); }
Intake VelocityEstimator::Add(const SteeringReading& reading) { return Take(reading, steering_); }
Intake VelocityEstimator::Add(const GnssReading& reading) { return Take(reading, gnss_); }

bool VelocityEstimator::BelievesJump(int64_t utime) {
  // One sensor with a broken clock must not take the filter along; all of them together are right.
  const bool goes_on =
      ahead_in_a_row_ > 0 && std::abs(SecondsBetween(ahead_utime_, utime)) <= params_.max_gap;
  ahead_in_a_row_ = goes_on ? ahead_in_a_row_ + 1 : 1;
  ahead_utime_ = utime;
  return ahead_in_a_row_ > kReadingsToBelieveAJump;
}

bool VelocityEstimator::IsImuSilentAt(int64_t utime) const {
  const std::optional<int64_t> heard = imu_.last_utime ? imu_.last_utime : first_utime_;
  return heard && SecondsBetween(*heard, utime) > params_.deadlines.imu;
}

template <class Reading>
std::optional<Reading> VelocityEstimator::Collect(Inbox<Reading>& inbox) const {
  std::optional<Reading> reading;
  reading.swap(inbox.waiting);
  if (reading && std::abs(SecondsBetween(reading->utime, *utime_)) > params_.max_age)
    reading.reset();
  return reading;
}

Readings VelocityEstimator::CollectAll() {
  Readings readings{Collect(imu_), Collect(ground_speed_), Collect(motors_), Collect(steering_),
                    Collect(gnss_)};
  if (readings.motors) last_motors_ = readings.motors;
  if (readings.ground_speed) last_ground_speed_ = readings.ground_speed;
  if (readings.steering) last_steering_ = readings.steering;
  const bool is_fresh = last_steering_ && SecondsBetween(last_steering_->utime, *utime_) <=
                                              params_.deadlines.steering;
  readings.steering = is_fresh ? last_steering_ : std::nullopt;
  return readings;
}

VelocityEstimate VelocityEstimator::Advance(int64_t utime) {
  if (utime_ && utime <= *utime_)
    throw std::invalid_argument("VelocityEstimator: time does not increase");
  const double dt = utime_ ? SecondsBetween(*utime_, utime) : 0.0;
  if (!utime_ || dt > params_.max_gap) filter_.Restart(utime);
  utime_ = utime;
  filter_.PredictTo(utime);
  Readings readings = CollectAll();
  const std::optional<ImuReading> raw_imu = readings.imu;
  if (readings.imu) {
    readings.imu->yaw_rate -= standstill_.gyro_bias();
    readings.imu->acceleration -= standstill_.accelerometer_bias();
  }
  filter_.Fuse(readings);
  if (raw_imu) FuseStandstill(*raw_imu, dt);
  if (IsLost()) filter_.Restart(utime);
  return Estimate();
}

void VelocityEstimator::FuseStandstill(const ImuReading& imu, double dt) {
  const auto fresh = [this](const auto& reading, double deadline) {
    const bool is_fresh = reading && SecondsBetween(reading->utime, *utime_) <= deadline;
    return is_fresh ? reading : std::nullopt;
  };
  const auto motors = fresh(last_motors_, params_.deadlines.motors);
  const auto ground_speed = fresh(last_ground_speed_, params_.deadlines.ground_speed);
  if (standstill_.Detect(imu, motors, ground_speed) && filter_.FuseStandstill())
    standstill_.LearnBias(imu, dt);
}

bool VelocityEstimator::IsLost() const {
  if (filter_.velocity_sigma() > VelocityFilter::kPriorVelocitySigma) return true;
  // A filter that every sensor of velocity contradicts is the one that is wrong.
  const SensorStates states = filter_.StatesAt(*utime_);
  int used = 0;
  int rejected = 0;
  for (const SensorState state : {states.ground_speed, states.motors, states.gnss}) {
    used += state == SensorState::kUsed ? 1 : 0;
    rejected += state == SensorState::kRejected ? 1 : 0;
  }
  return used == 0 && rejected >= 2;
}

VelocityEstimate VelocityEstimator::Estimate() const {
  const StateVector& state = filter_.mean();
  VelocityEstimate estimate;
  estimate.utime = *utime_;
  estimate.valid = filter_.IsCertain();
  estimate.velocity = {state[kVelocity], state[kVelocity + 1], state[kYawRate]};
  const Eigen::Matrix3d covariance = filter_.covariance().topLeftCorner<3, 3>();
  estimate.covariance = 0.5 * (covariance + covariance.transpose());
  estimate.acceleration = state.segment<2>(kAcceleration);
  for (size_t i = 0; i < estimate.slip.size(); ++i)
    estimate.slip[i] = state[kSlip + static_cast<int>(i)];
  estimate.states = filter_.StatesAt(*utime_);
  estimate.innovations = filter_.innovations();
  return estimate;
}

}  // namespace hairpin
