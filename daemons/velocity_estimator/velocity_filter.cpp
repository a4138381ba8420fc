#include "daemons/velocity_estimator/velocity_filter.hpp"

#include <algorithm>
#include <cmath>

#include "common/clock.hpp"

namespace hairpin {
namespace {

constexpr double kPriorYawRateSigma = 2.0;        // rad/s
constexpr double kPriorAccelerationSigma = 10.0;  // m/s^2
constexpr double kLongestStep = 0.02;             // s, of one prediction over a gap
constexpr double kMovingSpeed = 1.0;              // m/s from which a live sensor shows noise

StateMatrix PriorCovariance(const SlipParams& slip) {
  StateVector sigmas;
  sigmas.segment<2>(kVelocity).setConstant(VelocityFilter::kPriorVelocitySigma);
  sigmas[kYawRate] = kPriorYawRateSigma;
  sigmas.segment<2>(kAcceleration).setConstant(kPriorAccelerationSigma);
  sigmas.segment<4>(kSlip).setConstant(slip.sigma_free);
  return sigmas.cwiseAbs2().asDiagonal();
}

Eigen::Matrix<double, 1, 1> Scalar(double value) { return Eigen::Matrix<double, 1, 1>(value); }

void TakeBack(std::span<SensorMonitor> sensors) {
  for (SensorMonitor& sensor : sensors) sensor.TakeBack();
}

}  // namespace

VelocityFilter::VelocityFilter(const VelocityEstimatorParams& params)
    : params_(params),
      slip_model_(params.slip, params.tyre, params.car),
      filter_(StateVector::Zero(), PriorCovariance(params.slip)),
      votes_(params),
      gyro_(params.monitor, params.deadlines.imu),
      accelerometer_(params.monitor, params.deadlines.imu),
      ground_speed_(params.monitor, params.deadlines.ground_speed),
      gnss_(params.monitor, params.deadlines.gnss),
      wheels_{SensorMonitor(params.monitor, params.deadlines.motors),
              SensorMonitor(params.monitor, params.deadlines.motors),
              SensorMonitor(params.monitor, params.deadlines.motors),
              SensorMonitor(params.monitor, params.deadlines.motors)} {}

void VelocityFilter::Restart(int64_t utime) {
  // A sensor that stood still before does so afterwards, too.
  std::array<SensorMonitor, 4> wheels = wheels_;
  for (SensorMonitor& wheel : wheels) wheel.Forgive();
  SensorMonitor ground_speed = ground_speed_;
  ground_speed.Forgive();
  *this = VelocityFilter(params_);
  wheels_ = wheels;
  ground_speed_ = ground_speed;
  utime_ = utime;
}

void VelocityFilter::PredictTo(int64_t utime) {
  const double duration = SecondsBetween(utime_, utime);
  utime_ = utime;
  step_ = std::max(0.0, duration);
  if (duration <= 0.0) return;
  const int steps = static_cast<int>(std::ceil(duration / kLongestStep));
  const double dt = duration / steps;
  const double decay = slip_model_.Decay(dt);
  for (int i = 0; i < steps; ++i) {
    const Wheels sigmas = slip_model_.Sigmas(torque_, mean()[kAcceleration]);
    const auto process = [this, dt, decay](const StateVector& state) {
      StateVector moved = Move(state, dt);
      const double slip = slip_model_.Mean(state[kAcceleration]);
      moved.segment<4>(kSlip).array() = slip + decay * (state.segment<4>(kSlip).array() - slip);
      return moved;
    };
    filter_.Predict(process, ProcessNoise(params_.motion, sigmas, decay, dt));
  }
}

void VelocityFilter::Fuse(const Readings& readings) {
  innovations_ = {};
  NoteMotion(readings);
  if (readings.motors) torque_ = readings.motors->torque;
  const Wheels sigmas = slip_model_.Sigmas(torque_, mean()[kAcceleration]);
  if (IsCertain()) votes_.Cast(utime_, mean(), readings, WheelsAt(readings.steering), sigmas);
  FollowMajorities();
  if (readings.imu) FuseImu(*readings.imu);
  if (readings.ground_speed) FuseGroundSpeed(*readings.ground_speed);
  if (readings.motors) FuseMotors(*readings.motors, readings.steering);
  if (readings.gnss) FuseGnss(*readings.gnss);
  if (readings.steering && gyro_.StateAt(utime_) != SensorState::kUsed)
    FuseSteering(*readings.steering);
  const bool is_lateral_known = ground_speed_.StateAt(utime_) == SensorState::kUsed ||
                                gnss_.StateAt(utime_) == SensorState::kUsed;
  if (!is_lateral_known) FuseRearAxle();
}

void VelocityFilter::FollowMajorities() {
  // The filter has followed the outvoted sensor, and may have rejected the sound ones for it: let
  // it come back to them.
  StateVector errors = StateVector::Zero();
  const std::array<std::span<SensorMonitor>, SensorVotes::kNumSpeedVoters> speed{
      std::span(&ground_speed_, 1), std::span(wheels_), std::span(&gnss_, 1)};
  const auto forward = votes_.forward().MinorityAt(utime_);
  if (forward && Overrule(speed, forward->voter)) errors.head<2>().setConstant(forward->error);
  // The heading only votes: the filter does not use its change.
  const std::array<std::span<SensorMonitor>, SensorVotes::kNumYawVoters> yaw_rate{
      std::span(&gyro_, 1), std::span(&accelerometer_, 1), std::span<SensorMonitor>()};
  const auto turned = votes_.yaw_rate().MinorityAt(utime_);
  if (turned && Overrule(yaw_rate, turned->voter)) errors[kYawRate] = turned->error;
  // Where all sensors of speed contradict the filter, what carries it between them is wrong: the
  // accelerometer.
  for (const ConsistencyVote* vote : {&votes_.forward(), &votes_.lateral()}) {
    const std::optional<double> error = vote->FilterErrorAt(utime_);
    if (!error || accelerometer_.is_out()) continue;
    accelerometer_.TakeOut(utime_);
    for (const auto& sensor : speed) TakeBack(sensor);
    errors.head<2>().setConstant(*error);
  }
  if (!errors.isZero()) filter_.Inflate(errors.cwiseAbs2().asDiagonal());
}

bool VelocityFilter::Overrule(std::span<const std::span<SensorMonitor>> voters, size_t minority) {
  const auto is_in = [](const SensorMonitor& sensor) { return !sensor.is_out(); };
  const bool is_news = std::any_of(voters[minority].begin(), voters[minority].end(), is_in);
  for (SensorMonitor& sensor : voters[minority]) sensor.TakeOut(utime_);
  for (size_t voter = 0; voter < voters.size(); ++voter) {
    if (!is_news || voter == minority) continue;
    TakeBack(voters[voter]);
  }
  return is_news;
}

void VelocityFilter::NoteMotion(const Readings& readings) {
  double speed = mean().segment<2>(kVelocity).norm();
  if (readings.ground_speed) speed = std::max(speed, readings.ground_speed->velocity.norm());
  if (readings.motors) {
    // The slower of two wheels: one may spin.
    Wheels speeds = readings.motors->speed;
    std::sort(speeds.begin(), speeds.end());
    speed = std::max(speed, speeds[1] * params_.car.wheel_radius);
  }
  is_moving_ = speed > kMovingSpeed;
}

template <int M, class Model>
double VelocityFilter::FuseGated(SensorMonitor& monitor, int64_t utime,
                                 const Eigen::Matrix<double, M, 1>& measured, const Model& model,
                                 const Eigen::Matrix<double, M, M>& noise, bool is_possible) {
  const double age = SecondsBetween(utime, utime_);
  const auto at_its_time = [age, &model](const StateVector& state) {
    return age == 0.0 ? model(state) : model(Move(state, -age));
  };
  const Innovation<kStateSize, M> innovation =
      filter_.template Compare<M>(measured, at_its_time, noise);
  Eigen::Vector2d reading = Eigen::Vector2d::Zero();
  reading.head<M>() = measured;
  const bool is_frozen = monitor.IsFrozen(utime, reading, is_moving_);
  if (is_frozen) monitor.TakeOut(utime);  // no doubt to wait for: what stands in begins at once
  const double gate = M == 1 ? params_.gate_1dof : params_.gate_2dof;
  const bool agrees = innovation.nis <= gate && !is_frozen && is_possible;
  if (monitor.Judge(utime, agrees)) filter_.Apply(innovation);
  return innovation.nis;
}

void VelocityFilter::FuseImu(const ImuReading& reading) {
  const auto yaw_rate = [](const StateVector& state) { return Scalar(state[kYawRate]); };
  innovations_.gyro = FuseGated<1>(gyro_, reading.utime, Scalar(reading.yaw_rate), yaw_rate,
                                   Scalar(std::pow(params_.noise.gyro, 2)));
  const auto acceleration = [](const StateVector& state) -> Eigen::Vector2d {
    return state.segment<2>(kAcceleration);
  };
  const Eigen::Matrix2d noise =
      Eigen::Matrix2d::Identity() * std::pow(params_.noise.accelerometer, 2);
  innovations_.accelerometer =
      FuseGated<2>(accelerometer_, reading.utime, reading.acceleration, acceleration, noise);
}

void VelocityFilter::FuseGroundSpeed(const GroundSpeedReading& reading) {
  const Eigen::Vector2d position = params_.car.ground_speed_position;
  const auto velocity = [&position](const StateVector& state) {
    return VelocityAt(state, position);
  };
  const double scale = params_.noise.ground_speed_scale * reading.velocity.norm();
  const double variance = std::pow(params_.noise.ground_speed, 2) + scale * scale;
  innovations_.ground_speed = FuseGated<2>(ground_speed_, reading.utime, reading.velocity, velocity,
                                           Eigen::Matrix2d(Eigen::Matrix2d::Identity() * variance));
}

void VelocityFilter::FuseMotors(const MotorsReading& reading,
                                const std::optional<SteeringReading>& steering) {
  const auto wheels = WheelsAt(steering);
  // Without the steering angle a slow front wheel may roll in any direction.
  const bool is_front_known = steering || mean()[kVelocity] > params_.slip.min_speed;
  for (size_t i = is_front_known ? 0 : 2; i < wheels.size(); ++i) {
    const double steering_sigma = i < 2 && steering ? params_.noise.steering : 0.0;
    FuseWheel(i, reading, wheels[i], steering_sigma);
  }
}

std::array<WheelGeometry, 4> VelocityFilter::WheelsAt(
    const std::optional<SteeringReading>& steering) const {
  return steering ? WheelGeometries(params_.car, steering->angle)
                  : WheelGeometriesAlong(params_.car, mean());
}

void VelocityFilter::FuseWheel(size_t index, const MotorsReading& reading,
                               const WheelGeometry& wheel, double steering_sigma) {
  const double radius = params_.car.wheel_radius;
  const double min_speed = params_.slip.min_speed;
  const int slip_index = kSlip + static_cast<int>(index);
  const auto speed = [&](const StateVector& state) {
    return Scalar(WheelSpeed(HubSpeed(state, wheel), state[slip_index], radius, min_speed));
  };
  const Eigen::Vector2d across(-wheel.direction.y(), wheel.direction.x());
  const double steering = steering_sigma * across.dot(VelocityAt(mean(), wheel.position)) / radius;
  const double variance = std::pow(params_.noise.wheel_speed, 2) + steering * steering;
  const Wheels sigmas = slip_model_.Sigmas(reading.torque, mean()[kAcceleration]);
  const bool is_possible = IsSlipPossible(wheel, reading.speed[index] * radius, sigmas[index]);
  innovations_.wheels[index] =
      FuseGated<1>(wheels_[index], reading.utime, Scalar(reading.speed[index]), speed,
                   Scalar(variance), is_possible);
}

void VelocityFilter::FuseSteering(const SteeringReading& reading) {
  // Kinematic bicycle, r = v_x tan(delta) / L. Tyres slip, so it is a poor stand-in for the gyro.
  const double curvature = std::tan(reading.angle) / params_.car.wheelbase();
  const auto residual = [curvature](const StateVector& state) {
    return Scalar(state[kYawRate] - state[kVelocity] * curvature);
  };
  const double expected = std::abs(mean()[kVelocity] * curvature);
  const double sigma =
      params_.noise.steering_yaw_rate + params_.noise.steering_yaw_rate_scale * expected;
  const auto innovation = filter_.Compare<1>(Scalar(0.0), residual, Scalar(sigma * sigma));
  if (innovation.nis <= params_.gate_1dof) filter_.Apply(innovation);
}

void VelocityFilter::FuseRearAxle() {
  const double speed = mean()[kVelocity];
  if (step_ <= 0.0 || speed < params_.slip.min_speed) return;
  const auto slide = [this](const StateVector& state) {
    return Scalar(RearAxleSlide(state, params_));
  };
  const LateralTyreParams& tyre = params_.tyre;
  const double angle = std::abs(SlipAngle(mean()[kAcceleration + 1], tyre, params_.slip.friction));
  const double sigma = speed * (tyre.sigma_angle + tyre.sigma_angle_share * angle);
  // The error lasts: readings of one time constant together tell no more than one.
  const double repeats = std::max(1.0, 2.0 * tyre.angle_time_constant / step_);
  filter_.Apply(filter_.Compare<1>(Scalar(0.0), slide, Scalar(sigma * sigma * repeats)));
}

bool VelocityFilter::IsSlipPossible(const WheelGeometry& wheel, double rolling_speed,
                                    double slip_sigma) const {
  // Against the slip that the torque allows, not against the slip state: that would follow a
  // drifting wheel along.
  const double hub_speed = HubSpeed(mean(), wheel);
  const double lever =
      wheel.direction.y() * wheel.position.x() - wheel.direction.x() * wheel.position.y();
  const Eigen::Vector3d gradient(wheel.direction.x(), wheel.direction.y(),
                                 lever);  // of the hub speed by vx, vy, r
  const double hub_variance = gradient.dot(covariance().topLeftCorner<3, 3>() * gradient);
  const double slip_speed = slip_sigma * std::max(std::abs(hub_speed), params_.slip.min_speed);
  const double noise = params_.noise.wheel_speed * params_.car.wheel_radius;
  const double slip = slip_model_.Mean(mean()[kAcceleration]);
  const double residual =
      rolling_speed - hub_speed - slip * std::max(std::abs(hub_speed), params_.slip.min_speed);
  return residual * residual <=
         params_.gate_1dof * (hub_variance + slip_speed * slip_speed + noise * noise);
}

void VelocityFilter::FuseGnss(const GnssReading& reading) {
  const Eigen::Vector2d position = params_.car.gnss_position;
  const auto velocity = [&position](const StateVector& state) {
    return VelocityAt(state, position);
  };
  innovations_.gnss = FuseGated<2>(gnss_, reading.utime, VelocityInBase(reading), velocity,
                                   CovarianceInBase(reading, params_.noise));
}

bool VelocityFilter::FuseStandstill() {
  const auto velocity = [](const StateVector& state) -> Eigen::Vector2d {
    return state.segment<2>(kVelocity);
  };
  const double variance = std::pow(params_.standstill.velocity_sigma, 2);
  const auto still = filter_.Compare<2>(Eigen::Vector2d::Zero().eval(), velocity,
                                        Eigen::Matrix2d(Eigen::Matrix2d::Identity() * variance));
  if (still.nis > params_.gate_2dof) return false;
  filter_.Apply(still);
  const auto yaw_rate = [](const StateVector& state) { return Scalar(state[kYawRate]); };
  filter_.Apply(filter_.Compare<1>(Scalar(0.0), yaw_rate,
                                   Scalar(std::pow(params_.standstill.yaw_rate_sigma, 2))));
  return true;
}

double VelocityFilter::velocity_sigma() const {
  return std::sqrt(std::max(covariance()(0, 0), covariance()(1, 1)));
}

double VelocityFilter::yaw_rate_sigma() const {
  return std::sqrt(covariance()(kYawRate, kYawRate));
}

bool VelocityFilter::IsCertain() const {
  return velocity_sigma() <= params_.max_velocity_sigma &&
         yaw_rate_sigma() <= params_.max_yaw_rate_sigma;
}

SensorStates VelocityFilter::StatesAt(int64_t utime) const {
  return {gyro_.StateAt(utime), accelerometer_.StateAt(utime), ground_speed_.StateAt(utime),
          MotorsStateAt(utime), gnss_.StateAt(utime)};
}

SensorState VelocityFilter::MotorsStateAt(int64_t utime) const {
  int used = 0;
  int heard = 0;
  for (const SensorMonitor& wheel : wheels_) {
    const SensorState state = wheel.StateAt(utime);
    used += state == SensorState::kUsed ? 1 : 0;
    heard += state != SensorState::kSilent ? 1 : 0;
  }
  if (heard == 0) return SensorState::kSilent;
  return used >= 2 ? SensorState::kUsed : SensorState::kRejected;
}

}  // namespace hairpin
