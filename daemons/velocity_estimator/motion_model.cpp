#include "daemons/velocity_estimator/motion_model.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry.hpp"

namespace hairpin {
namespace {

constexpr double kGravity = 9.81;  // m/s^2

Eigen::Vector2d VelocityRate(const StateVector& state, const Eigen::Vector2d& velocity) {
  const Eigen::Vector2d turned(velocity.y(), -velocity.x());
  return state.segment<2>(kAcceleration) + state[kYawRate] * turned;
}

}  // namespace

StateVector Move(const StateVector& state, double dt) {
  // Midpoint rule: exact to second order in the angle turned, where Euler's would grow the speed.
  const Eigen::Vector2d velocity = state.segment<2>(kVelocity);
  const Eigen::Vector2d middle = velocity + 0.5 * dt * VelocityRate(state, velocity);
  StateVector moved = state;
  moved.segment<2>(kVelocity) = velocity + dt * VelocityRate(state, middle);
  return moved;
}

Eigen::Vector2d VelocityAt(const StateVector& state, const Eigen::Vector2d& position) {
  return {state[kVelocity] - state[kYawRate] * position.y(),
          state[kVelocity + 1] + state[kYawRate] * position.x()};
}

double SlipAngle(double acceleration, const LateralTyreParams& tyre, double friction) {
  constexpr double kNearTheLimit = 0.95;
  const double used =
      std::clamp(acceleration / (friction * kGravity), -kNearTheLimit, kNearTheLimit);
  const double b = tyre.stiffness / (tyre.shape * friction);
  return std::tan(std::asin(used) / tyre.shape) / b;
}

double SlipModel::Mean(double acceleration) const {
  const double limit = params_.friction * kGravity;
  return std::clamp(acceleration, -limit, limit) / (kGravity * tyre_.stiffness);
}

Wheels SlipModel::Sigmas(const std::optional<Wheels>& torque, double acceleration) const {
  const double force_limit = params_.friction * car_.mass * kGravity / 4.0;
  const double braking = car_.mass * std::max(0.0, -acceleration);
  const double driving = torque ? 0.0 : car_.mass * std::max(0.0, acceleration) / 4.0;
  Wheels sigmas;
  for (size_t i = 0; i < sigmas.size(); ++i) {
    const double brake_share = i < 2 ? car_.front_brake_share : 1.0 - car_.front_brake_share;
    const double motor = torque ? std::abs((*torque)[i]) / car_.wheel_radius : driving;
    const double force = std::max(motor, 0.5 * brake_share * braking);
    sigmas[i] = params_.sigma_free + params_.sigma_at_limit * std::min(1.0, force / force_limit);
  }
  return sigmas;
}

double SlipModel::Decay(double dt) const { return std::exp(-dt / params_.time_constant); }

StateMatrix ProcessNoise(const MotionNoise& noise, const Wheels& slip_sigmas, double slip_decay,
                         double dt) {
  StateVector variances;
  variances.segment<2>(kVelocity).setConstant(noise.velocity * noise.velocity * dt);
  variances[kYawRate] = noise.yaw_rate * noise.yaw_rate * dt;
  variances.segment<2>(kAcceleration).setConstant(noise.acceleration * noise.acceleration * dt);
  for (size_t i = 0; i < slip_sigmas.size(); ++i) {
    // Keeps the stationary variance: sigma^2 = decay^2 sigma^2 + q.
    variances[kSlip + static_cast<int>(i)] =
        (1.0 - slip_decay * slip_decay) * slip_sigmas[i] * slip_sigmas[i];
  }
  return variances.asDiagonal();
}

std::array<WheelGeometry, 4> WheelGeometries(const Car& car, double steering_angle) {
  const std::array<Eigen::Vector2d, 4> positions = car.wheel_positions();
  const Eigen::Vector2d front(std::cos(steering_angle), std::sin(steering_angle));
  const Eigen::Vector2d rear = Eigen::Vector2d::UnitX();
  return {
      {{positions[0], front}, {positions[1], front}, {positions[2], rear}, {positions[3], rear}}};
}

std::array<WheelGeometry, 4> WheelGeometriesAlong(const Car& car, const StateVector& state) {
  std::array<WheelGeometry, 4> wheels = WheelGeometries(car, 0.0);
  for (size_t i = 0; i < 2; ++i) {
    const Eigen::Vector2d velocity = VelocityAt(state, wheels[i].position);
    if (velocity.x() > 0.0) wheels[i].direction = velocity.normalized();
  }
  return wheels;
}

double RearAxleSlide(const StateVector& state, const VelocityEstimatorParams& params) {
  const double lateral = VelocityAt(state, {-params.car.rear_axle, 0.0}).y();
  const double angle = SlipAngle(state[kAcceleration + 1], params.tyre, params.slip.friction);
  return lateral + state[kVelocity] * angle;
}

double HubSpeed(const StateVector& state, const WheelGeometry& wheel) {
  return wheel.direction.dot(VelocityAt(state, wheel.position));
}

double WheelSpeed(double hub_speed, double slip, double radius, double min_speed) {
  return (hub_speed + slip * std::max(std::abs(hub_speed), min_speed)) / radius;
}

Eigen::Vector2d VelocityInBase(const GnssReading& reading) {
  return Pose2{0.0, 0.0, -reading.heading}.rotation() * reading.velocity_enu;
}

Eigen::Matrix2d CovarianceInBase(const GnssReading& reading, const SensorNoise& noise) {
  const Eigen::Vector2d sigma = reading.velocity_sigma.cwiseMax(noise.gnss_velocity);
  const double heading_sigma = std::max(reading.heading_sigma, noise.gnss_heading);
  const Eigen::Matrix2d enu = sigma.cwiseAbs2().asDiagonal();
  const Eigen::Vector2d velocity = VelocityInBase(reading);
  const Eigen::Vector2d across = heading_sigma * Eigen::Vector2d(velocity.y(), -velocity.x());
  return RotateCovariance(enu, -reading.heading) + across * across.transpose();
}

}  // namespace hairpin
