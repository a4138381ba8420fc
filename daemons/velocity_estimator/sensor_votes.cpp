#include "daemons/velocity_estimator/sensor_votes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/clock.hpp"
#include "common/geometry.hpp"

namespace hairpin {
namespace {

double MiddleOf(std::array<double, 4> values) {
  std::sort(values.begin(), values.end());
  return 0.5 * (values[1] + values[2]);
}

}  // namespace

SensorVotes::SensorVotes(const VelocityEstimatorParams& params)
    : params_(params),
      forward_(params.vote.time_constant),
      lateral_(params.vote.time_constant),
      yaw_rate_(params.vote.time_constant) {}

void SensorVotes::Cast(int64_t utime, const StateVector& state, const Readings& readings,
                       const std::array<WheelGeometry, 4>& wheels, const Wheels& slip_sigmas) {
  turned_ += state[kYawRate] * SecondsBetween(utime_, utime);
  utime_ = utime;
  if (readings.imu) CastImu(state, *readings.imu);
  if (readings.ground_speed) CastGroundSpeed(state, *readings.ground_speed);
  if (readings.motors) CastMotors(state, *readings.motors, wheels, slip_sigmas);
  if (readings.gnss) CastGnss(state, *readings.gnss);
}

double SensorVotes::SpeedTolerance(double speed) const {
  return params_.vote.speed_offset + params_.vote.speed_scale * speed;
}

void SensorVotes::CastImu(const StateVector& state, const ImuReading& reading) {
  yaw_rate_.Cast(kGyro, reading.utime, reading.yaw_rate - state[kYawRate], params_.vote.gyro_offset,
                 params_.deadlines.imu);
  const double speed = state[kVelocity];
  if (speed < params_.vote.min_speed) return;
  // a_y = v_y' + r v_x, and v_y' averages out.
  const double residual = reading.acceleration.y() / speed - state[kYawRate];
  yaw_rate_.Cast(kLateralAcceleration, reading.utime, residual,
                 params_.vote.lateral_acceleration / speed, params_.deadlines.imu);
}

void SensorVotes::CastMotors(const StateVector& state, const MotorsReading& reading,
                             const std::array<WheelGeometry, 4>& wheels,
                             const Wheels& slip_sigmas) {
  std::array<double, 4> residuals;
  for (size_t i = 0; i < residuals.size(); ++i) {
    residuals[i] = reading.speed[i] * params_.car.wheel_radius - HubSpeed(state, wheels[i]);
  }
  // Twice the slip's deviation: more is improbable for the average of wheels and time.
  const double slip = 2.0 * *std::min_element(slip_sigmas.begin(), slip_sigmas.end());
  const double slip_speed = slip * std::abs(state[kVelocity]);
  forward_.Cast(kWheels, reading.utime, MiddleOf(residuals), params_.vote.speed_offset + slip_speed,
                params_.deadlines.motors);
}

void SensorVotes::CastGroundSpeed(const StateVector& state, const GroundSpeedReading& reading) {
  const Eigen::Vector2d residual =
      reading.velocity - VelocityAt(state, params_.car.ground_speed_position);
  const double tolerance = SpeedTolerance(reading.velocity.norm());
  forward_.Cast(kGroundSpeed, reading.utime, residual.x(), tolerance,
                params_.deadlines.ground_speed);
  lateral_.Cast(kGroundSpeed, reading.utime, residual.y(), tolerance,
                params_.deadlines.ground_speed);
}

void SensorVotes::CastGnss(const StateVector& state, const GnssReading& reading) {
  const Eigen::Vector2d velocity = VelocityInBase(reading);
  const Eigen::Vector2d residual = velocity - VelocityAt(state, params_.car.gnss_position);
  const double tolerance = SpeedTolerance(velocity.norm());
  forward_.Cast(kGnss, reading.utime, residual.x(), tolerance, params_.deadlines.gnss);
  lateral_.Cast(kGnss, reading.utime, residual.y(), tolerance, params_.deadlines.gnss);
  const double dt = last_gnss_ ? SecondsBetween(last_gnss_->utime, reading.utime) : 0.0;
  if (dt > 0.0 && dt <= params_.deadlines.gnss) {
    const double residual_rate = WrapAngle(reading.heading - last_gnss_->heading - turned_) / dt;
    yaw_rate_.Cast(kHeading, reading.utime, residual_rate, params_.vote.heading_rate,
                   params_.deadlines.gnss);
  }
  turned_ = 0.0;
  last_gnss_ = reading;
}

}  // namespace hairpin
