#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "daemons/velocity_estimator/velocity_estimator.hpp"
#include "daemons/velocity_estimator/velocity_estimator_node.hpp"

namespace hairpin {

/// Parameters as shipped.
inline VelocityEstimatorNodeParams ShippedParams() {
  return LoadVelocityEstimatorParams(
      Config::Load(HAIRPIN_SOURCE_DIR "/config", "velocity_estimator"));
}

struct DriveTruth {
  double t = 0.0;
  Twist2 velocity;
  Eigen::Vector2d acceleration = Eigen::Vector2d::Zero();
  double heading = 0.0;
  double steering = 0.0;
  Wheels slip{};
  Wheels torque{};
};

/// What is asked of the car at a time: longitudinal acceleration [m/s^2] and yaw rate [rad/s].
struct DriveDemand {
  double acceleration = 0.0;
  double yaw_rate = 0.0;
};

/// Noise as in the data sheets that config/velocity_estimator.yaml names; zero them for an exact
/// drive.
struct DriveNoise {
  double scale = 1.0;  // of all white noise
  double gyro_bias = 0.0009;
  Eigen::Vector2d accelerometer_bias = {0.03, -0.04};
  double ground_speed_scale = 1.003;
};

/// A kinematic car with sideslip, load on the tyres' slip and sensors at their mounts, at 100 Hz.
/// It shares no code with the estimator, so that a forgotten lever arm shows.
class SimulatedDrive {
 public:
  SimulatedDrive(const Car& car, std::function<DriveDemand(double)> demand, DriveNoise noise = {},
                 uint32_t seed = 1)
      : car_(car), demand_(std::move(demand)), noise_(noise), random_(seed) {}

  static constexpr int64_t kStart = 1'700'000'000'000'000;
  static constexpr double kPeriod = 0.01;
  static int64_t UtimeAt(double t) { return kStart + static_cast<int64_t>(std::llround(t * 1e6)); }

  /// Moves on by one period.
  const DriveTruth& Step() {
    constexpr int kSubsteps = 10;
    for (int i = 0; i < kSubsteps; ++i) Integrate(kPeriod / kSubsteps);
    ++ticks_;
    truth_.t = ticks_ * kPeriod;
    return truth_;
  }

  /// The readings of this time; GNSS at 10 Hz.
  Readings Measure() {
    const int64_t utime = UtimeAt(truth_.t);
    const Twist2& v = truth_.velocity;
    Readings readings;
    readings.imu = ImuReading{utime, truth_.acceleration + noise_.accelerometer_bias + Noise2(0.05),
                              v.yaw_rate + noise_.gyro_bias + Noise(0.0035)};
    const Eigen::Vector2d optical = At(car_.ground_speed_position) * noise_.ground_speed_scale;
    readings.ground_speed = GroundSpeedReading{utime, optical + Noise2(0.05)};
    readings.motors = MotorsReading{utime, WheelSpeeds(), truth_.torque};
    readings.steering = SteeringReading{utime, truth_.steering + Noise(0.0035)};
    if (ticks_ % 10 == 0) {
      const Eigen::Vector2d base = At(car_.gnss_position);
      const double c = std::cos(truth_.heading);
      const double s = std::sin(truth_.heading);
      const Eigen::Vector2d enu(c * base.x() - s * base.y(), s * base.x() + c * base.y());
      readings.gnss = GnssReading{
          utime, enu + Noise2(0.05), {0.05, 0.05}, truth_.heading + Noise(0.0052), 0.0052};
    }
    return readings;
  }

 private:
  void Integrate(double dt) {
    DriveDemand demand = demand_(truth_.t);
    if (vx_ <= 0.0) demand = {std::max(0.0, demand.acceleration), 0.0};
    const double rate = (demand.acceleration - forward_) / 0.05;  // actuators lag
    forward_ += rate * dt;
    truth_.velocity.yaw_rate += (demand.yaw_rate - truth_.velocity.yaw_rate) / 0.1 * dt;
    const double r = truth_.velocity.yaw_rate;
    const double before = truth_.velocity.vy;
    vx_ = std::max(0.0, vx_ + forward_ * dt);
    // Rear axle: lateral velocity is minus the slip angle, proportional to the lateral
    // acceleration.
    truth_.velocity.vx = vx_;
    truth_.velocity.vy = car_.rear_axle * r - r * vx_ / 60.0 * vx_;
    const double vx_rate = vx_ > 0.0 ? forward_ : 0.0;
    truth_.acceleration = {vx_rate - r * truth_.velocity.vy,
                           (truth_.velocity.vy - before) / dt + r * vx_};
    truth_.heading += r * dt;
    const double front_vy = truth_.velocity.vy + r * car_.front_axle;
    truth_.steering = vx_ > 1.0 ? std::atan2(front_vy, vx_) + r * vx_ / 55.0 : 0.0;
    LoadTyres();
    truth_.t += dt;
  }

  void LoadTyres() {
    const double force = car_.mass * truth_.acceleration.x();
    for (size_t i = 0; i < 4; ++i) {
      const double share = force >= 0.0 ? 0.25 : (i < 2 ? 0.3 : 0.2);
      const double use = share * force / (car_.mass * 9.81 / 4.0);
      truth_.slip[i] = vx_ > 0.5 ? use / 27.7 * (1.0 + 0.4 * use * use) : 0.0;
      truth_.torque[i] =
          force > 0.0 ? 0.25 * force * car_.wheel_radius : 0.0;  // friction brakes otherwise
    }
  }

  Wheels WheelSpeeds() {
    Wheels speeds;
    const double half = 0.5 * car_.track_width;
    for (size_t i = 0; i < 4; ++i) {
      const bool front = i < 2;
      const Eigen::Vector2d hub =
          At({front ? car_.front_axle : -car_.rear_axle, i % 2 == 0 ? half : -half});
      const double angle = front ? truth_.steering : 0.0;
      const double rolling = hub.x() * std::cos(angle) + hub.y() * std::sin(angle);
      speeds[i] = rolling * (1.0 + truth_.slip[i]) / car_.wheel_radius + Noise(0.1);
    }
    return speeds;
  }

  Eigen::Vector2d At(const Eigen::Vector2d& p) const {
    const Twist2& v = truth_.velocity;
    return {v.vx - v.yaw_rate * p.y(), v.vy + v.yaw_rate * p.x()};
  }
  double Noise(double sigma) { return noise_.scale * sigma * normal_(random_); }
  Eigen::Vector2d Noise2(double sigma) {
    const double x = Noise(sigma);
    return {x, Noise(sigma)};
  }

  Car car_;
  std::function<DriveDemand(double)> demand_;
  DriveNoise noise_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  DriveTruth truth_;
  double vx_ = 0.0;
  double forward_ = 0.0;
  int ticks_ = 0;
};

/// Two seconds of standing, then hard driving to 12 m/s with corners and braking at 8 m/s^2, in
/// rounds of 10 s.
inline DriveDemand HardLap(double t) {
  if (t < 2.0) return {};
  const double s = std::fmod(t - 2.0, 10.0);
  if (s < 1.2) return {7.0, 0.0};   // to about 11 m/s
  if (s < 2.7) return {0.0, 0.75};  // 8 m/s^2 to the left
  if (s < 4.2) return {0.0, -0.75};
  if (s < 5.0) return {-8.0, -0.2};  // to about 5 m/s
  if (s < 7.0) return {0.0, 1.0};
  if (s < 7.8) return {6.0, 0.0};
  if (s < 9.0) return {0.0, 0.6 * std::sin(5.0 * s)};
  return {-8.0, 0.0};
}

struct DriveSample {
  DriveTruth truth;
  VelocityEstimate estimate;
};

using Tamper = std::function<void(double t, Readings& readings)>;

inline void Offer(VelocityEstimator& estimator, const Readings& readings) {
  if (readings.motors) estimator.Add(*readings.motors);
  if (readings.steering) estimator.Add(*readings.steering);
  if (readings.ground_speed) estimator.Add(*readings.ground_speed);
  if (readings.gnss) estimator.Add(*readings.gnss);
  if (readings.imu) estimator.Add(*readings.imu);
}

/// Drives for `duration`, with every tick's readings tampered with.
inline std::vector<DriveSample> Drive(SimulatedDrive& drive, VelocityEstimator& estimator,
                                      double duration, const Tamper& tamper = {}) {
  std::vector<DriveSample> samples;
  while (static_cast<double>(samples.size()) * SimulatedDrive::kPeriod < duration) {
    const DriveTruth truth = drive.Step();
    Readings readings = drive.Measure();
    if (tamper) tamper(truth.t, readings);
    Offer(estimator, readings);
    samples.push_back({truth, estimator.Advance(SimulatedDrive::UtimeAt(truth.t))});
  }
  return samples;
}

struct DriveErrors {
  double vx_rms = 0.0;
  double vy_rms = 0.0;
  double yaw_rate_rms = 0.0;
  double vx_max = 0.0;
  double vy_max = 0.0;
  double yaw_rate_max = 0.0;
};

/// Over the valid samples from `from` to `to` [s].
inline DriveErrors ErrorsOf(const std::vector<DriveSample>& samples, double from, double to) {
  DriveErrors errors;
  double count = 0.0;
  for (const DriveSample& sample : samples) {
    if (sample.truth.t < from || sample.truth.t > to || !sample.estimate.valid) continue;
    const Twist2& e = sample.estimate.velocity;
    const Twist2& v = sample.truth.velocity;
    const Eigen::Vector3d error(e.vx - v.vx, e.vy - v.vy, e.yaw_rate - v.yaw_rate);
    errors.vx_rms += error.x() * error.x();
    errors.vy_rms += error.y() * error.y();
    errors.yaw_rate_rms += error.z() * error.z();
    errors.vx_max = std::max(errors.vx_max, std::abs(error.x()));
    errors.vy_max = std::max(errors.vy_max, std::abs(error.y()));
    errors.yaw_rate_max = std::max(errors.yaw_rate_max, std::abs(error.z()));
    ++count;
  }
  errors.vx_rms = std::sqrt(errors.vx_rms / count);
  errors.vy_rms = std::sqrt(errors.vy_rms / count);
  errors.yaw_rate_rms = std::sqrt(errors.yaw_rate_rms / count);
  return errors;
}

}  // namespace hairpin
