#include "daemons/velocity_estimator/velocity_estimator_node.hpp"

#include <algorithm>
#include <cmath>

namespace hairpin {
namespace {

// A motor that reports much more than its limit, or wheels turned past their stops, are garbage; a
// little more is noise.
constexpr double kTorqueMargin = 1.5;
constexpr double kSteeringMargin = 1.2;
// A wheel may spin faster than the car goes, but hardly twice as fast at top speed.
constexpr double kWheelSpinMargin = 2.0;

ImuReading ToReading(const imu_t& message) {
  return {message.utime,
          {message.acceleration_mps2[0], message.acceleration_mps2[1]},
          message.angular_rate_radps[2]};
}

GroundSpeedReading ToReading(const ground_speed_t& message) {
  return {message.utime, {message.velocity_mps[0], message.velocity_mps[1]}};
}

MotorsReading ToReading(const motors_t& message) {
  MotorsReading reading{message.utime, {}, Wheels{}};
  std::copy_n(message.wheel_speed_radps, 4, reading.speed.begin());
  std::copy_n(message.wheel_torque_nm, 4, reading.torque->begin());
  return reading;
}

SteeringReading ToReading(const steering_t& message) {
  return {message.utime, message.wheel_angle_rad};
}

GnssReading ToReading(const gnss_t& message) {
  return {message.utime,
          {message.velocity_enu_mps[0], message.velocity_enu_mps[1]},
          {message.velocity_sigma_mps[0], message.velocity_sigma_mps[1]},
          message.heading_rad,
          message.heading_sigma_rad};
}

bool IsWithin(const double* values, int count, double bound) {
  return std::all_of(values, values + count,
                     [bound](double value) { return std::abs(value) <= bound; });
}

velocity_t ToMessage(const VelocityEstimate& estimate) {
  velocity_t message{};
  message.utime = estimate.utime;
  message.valid = estimate.valid;
  message.vx_mps = estimate.velocity.vx;
  message.vy_mps = estimate.velocity.vy;
  message.yaw_rate_radps = estimate.velocity.yaw_rate;
  // Symmetric, so that Eigen's column-major order is row-major too.
  std::copy_n(estimate.covariance.data(), 9, message.covariance);
  std::copy_n(estimate.acceleration.data(), 2, message.acceleration_mps2);
  std::copy_n(estimate.slip.begin(), 4, message.wheel_slip);
  message.gyro_state = static_cast<int32_t>(estimate.states.gyro);
  message.accelerometer_state = static_cast<int32_t>(estimate.states.accelerometer);
  message.ground_speed_state = static_cast<int32_t>(estimate.states.ground_speed);
  message.motors_state = static_cast<int32_t>(estimate.states.motors);
  message.gnss_state = static_cast<int32_t>(estimate.states.gnss);
  return message;
}

}  // namespace

VelocityEstimatorNode::VelocityEstimatorNode(const VelocityEstimatorNodeParams& params, Bus& bus)
    : bus_(bus), car_(params.estimator.car), limits_(params.limits), estimator_(params.estimator) {
  bus.Subscribe(channels::kImu, [this](const imu_t& message) {
    if (!Take(channels::kImu, ProblemOf(message), ToReading(message))) return;
    // Another sensor may have led up to this very time while the IMU was silent.
    if (!estimator_.utime() || message.utime > *estimator_.utime()) Publish(message.utime);
  });
  bus.Subscribe(channels::kGroundSpeed, [this](const ground_speed_t& message) {
    if (Take(channels::kGroundSpeed, ProblemOf(message), ToReading(message)))
      PublishInPlaceOfImu(message.utime);
  });
  bus.Subscribe(channels::kMotors, [this](const motors_t& message) {
    if (Take(channels::kMotors, ProblemOf(message), ToReading(message)))
      PublishInPlaceOfImu(message.utime);
  });
  bus.Subscribe(channels::kSteering, [this](const steering_t& message) {
    Take(channels::kSteering, ProblemOf(message), ToReading(message));
  });
  bus.Subscribe(channels::kGnss, [this](const gnss_t& message) {
    Take(channels::kGnss, ProblemOf(message), ToReading(message));
  });
}

template <class M, class Reading>
bool VelocityEstimatorNode::Take(const Channel<M>& channel, const std::string& problem,
                                 const Reading& reading) {
  if (!problem.empty()) {
    bus_.Refuse(channel, problem);
    return false;
  }
  const Intake intake = estimator_.Add(reading);
  if (intake != Intake::kTaken) bus_.Refuse(channel, std::string(NameOf(intake)));
  return intake == Intake::kTaken;
}

void VelocityEstimatorNode::Publish(int64_t utime) {
  bus_.Publish(channels::kVelocity, ToMessage(estimator_.Advance(utime)));
}

void VelocityEstimatorNode::PublishInPlaceOfImu(int64_t utime) {
  const bool is_new = !estimator_.utime() || utime > *estimator_.utime();
  if (is_new && estimator_.IsImuSilentAt(utime)) Publish(utime);
}

std::string VelocityEstimatorNode::ProblemOf(const imu_t& message) const {
  if (!IsWithin(message.acceleration_mps2, 3, limits_.max_acceleration))
    return "absurd acceleration";
  if (!IsWithin(message.angular_rate_radps, 3, limits_.max_yaw_rate)) return "absurd angular rate";
  return {};
}

std::string VelocityEstimatorNode::ProblemOf(const ground_speed_t& message) const {
  if (message.quality < limits_.min_quality) return "quality too low";
  return IsWithin(message.velocity_mps, 2, limits_.max_speed) ? "" : "absurd speed";
}

std::string VelocityEstimatorNode::ProblemOf(const motors_t& message) const {
  const double max_wheel_speed = kWheelSpinMargin * limits_.max_speed / car_.wheel_radius;
  if (!IsWithin(message.wheel_speed_radps, 4, max_wheel_speed)) return "absurd wheel speed";
  return IsWithin(message.wheel_torque_nm, 4, kTorqueMargin * car_.max_wheel_torque)
             ? ""
             : "absurd torque";
}

std::string VelocityEstimatorNode::ProblemOf(const steering_t& message) const {
  const double bound = kSteeringMargin * car_.max_steering_angle;
  return IsWithin(&message.wheel_angle_rad, 1, bound) ? "" : "absurd steering angle";
}

std::string VelocityEstimatorNode::ProblemOf(const gnss_t& message) const {
  if (message.fix == gnss_t::FIX_UNKNOWN || message.fix == gnss_t::FIX_NONE) return "no fix";
  if (!message.heading_valid) return "no heading";
  if (!IsWithin(message.velocity_enu_mps, 2, limits_.max_speed)) return "absurd speed";
  const bool has_sigmas = message.velocity_sigma_mps[0] >= 0.0 &&
                          message.velocity_sigma_mps[1] >= 0.0 && message.heading_sigma_rad >= 0.0;
  if (!has_sigmas || !IsWithin(message.velocity_sigma_mps, 2, limits_.max_speed))
    return "absurd standard deviation";
  return message.heading_sigma_rad <= M_PI ? "" : "absurd standard deviation";
}

}  // namespace hairpin
