#include "daemons/velocity_estimator/velocity_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "tests/unit/velocity_estimator/simulated_drive.hpp"

namespace hairpin {
namespace {

/// A car drawn from the filter's own model: random walks of velocity, yaw rate and acceleration,
/// stationary slips.
class ModelCar {
 public:
  ModelCar(const VelocityEstimatorParams& params, uint32_t seed)
      : params_(params), slip_(params.slip, params.tyre, params.car), random_(seed) {
    state_.head<2>() << 15.0, 0.0;
    for (int i = 0; i < 4; ++i) state_[kSlip + i] = Draw(params.slip.sigma_free);
  }

  void Step() {
    ++tick_;
    const double decay = slip_.Decay(kPeriod);
    const StateMatrix noise =
        ProcessNoise(params_.motion, slip_.Sigmas({}, state_[kAcceleration]), decay, kPeriod);
    state_ = Move(state_, kPeriod);
    const double slip = slip_.Mean(state_[kAcceleration]);
    state_.tail<4>().array() = slip + decay * (state_.tail<4>().array() - slip);
    for (int i = 0; i < kStateSize; ++i) state_[i] += Draw(std::sqrt(noise(i, i)));
  }

  Readings Measure() {
    const SensorNoise& noise = params_.noise;
    Readings readings;
    readings.imu =
        ImuReading{utime(), state_.segment<2>(kAcceleration) + Draw2(noise.accelerometer),
                   state_[kYawRate] + Draw(noise.gyro)};
    const Eigen::Vector2d optical = VelocityAt(state_, params_.car.ground_speed_position);
    readings.ground_speed = GroundSpeedReading{
        utime(),
        optical + Draw2(std::hypot(noise.ground_speed, noise.ground_speed_scale * optical.norm()))};
    readings.motors = MotorsReading{utime(), {}, {}};
    const auto wheels = WheelGeometries(params_.car, 0.0);
    for (size_t i = 0; i < 4; ++i) {
      readings.motors->speed[i] =
          WheelSpeed(HubSpeed(state_, wheels[i]), state_[kSlip + static_cast<int>(i)],
                     params_.car.wheel_radius, params_.slip.min_speed) +
          Draw(noise.wheel_speed);
    }
    readings.steering = SteeringReading{utime(), Draw(noise.steering)};
    if (tick_ % 10 == 0) {
      readings.gnss = GnssReading{utime(),
                                  VelocityAt(state_, params_.car.gnss_position) + Draw2(0.05),
                                  {0.05, 0.05},
                                  Draw(noise.gnss_heading),
                                  noise.gnss_heading};
    }
    return readings;
  }

  const StateVector& state() const { return state_; }
  int64_t utime() const { return tick_ * 10'000; }

 private:
  static constexpr double kPeriod = 0.01;
  double Draw(double sigma) { return sigma * normal_(random_); }
  Eigen::Vector2d Draw2(double sigma) {
    const double x = Draw(sigma);
    return {x, Draw(sigma)};
  }

  VelocityEstimatorParams params_;
  SlipModel slip_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  StateVector state_ = StateVector::Zero();
  int64_t tick_ = 0;
};

TEST(VelocityFilter, IsAsCertainAsItShouldBeOnItsOwnModel) {
  VelocityEstimatorParams params = ShippedParams().estimator;
  params.motion.acceleration = 4.0;  // the walk would else leave the speeds at which slip is linear
  params.vote.lateral_acceleration = 1e3;  // it has no tyres: v_y' does not average out
  double nees = 0.0;
  int count = 0;
  for (uint32_t seed = 1; seed <= 100; ++seed) {
    ModelCar car(params, seed);
    VelocityFilter filter(params);
    filter.Restart(0);
    for (int tick = 0; tick < 150; ++tick) {
      car.Step();
      filter.PredictTo(car.utime());
      filter.Fuse(car.Measure());
      if (tick < 50 || tick % 10 != 0) continue;
      const StateVector error = filter.mean() - car.state();
      nees += error.dot(filter.covariance().llt().solve(error));
      ++count;
    }
  }
  // Chi-square with 9 degrees of freedom. The 1000 samples are correlated in time: 100 independent
  // runs give a standard deviation of sqrt(18 / 100) = 0.42 at worst.
  EXPECT_NEAR(nees / count, 9.0, 1.0);
}

TEST(VelocityFilter, StaysPositiveDefiniteWhateverComes) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  ModelCar car(params, 7);
  VelocityFilter filter(params);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> wild(-40.0, 40.0);
  for (int tick = 0; tick < 2000; ++tick) {
    if (tick % 200 == 0) car = ModelCar(params, static_cast<uint32_t>(tick));
    car.Step();
    Readings readings = car.Measure();
    if (tick % 3 == 0) readings.ground_speed->velocity = {wild(random), wild(random)};
    if (tick % 5 == 0)
      readings.motors->speed = {wild(random), wild(random), wild(random), wild(random)};
    if (tick % 7 == 0) readings.imu->acceleration = {wild(random), wild(random)};
    filter.PredictTo(tick * 10'000);
    filter.Fuse(readings);
    ASSERT_EQ(filter.covariance().llt().info(), Eigen::Success) << tick;
    ASSERT_TRUE(filter.mean().allFinite()) << tick;
  }
}

TEST(VelocityFilter, RefusesAStandstillItKnowsToBeFalse) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  VelocityFilter filter(params);
  EXPECT_TRUE(filter.FuseStandstill());
  EXPECT_LT(filter.velocity_sigma(), 0.011);
  ModelCar car(params, 1);
  VelocityFilter moving(params);
  for (int tick = 0; tick < 50; ++tick) {
    car.Step();
    moving.PredictTo(car.utime());
    moving.Fuse(car.Measure());
  }
  const StateVector before = moving.mean();
  EXPECT_FALSE(moving.FuseStandstill());
  EXPECT_EQ(moving.mean(), before);
}

}  // namespace
}  // namespace hairpin
