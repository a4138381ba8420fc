#include "daemons/velocity_estimator/motion_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hairpin {
namespace {

constexpr LateralTyreParams kTyre{.stiffness = 20.0,
                                  .shape = 1.4,
                                  .sigma_angle = 0.005,
                                  .sigma_angle_share = 0.3,
                                  .angle_time_constant = 0.5};

StateVector StateOf(double vx, double vy, double yaw_rate, double ax = 0.0, double ay = 0.0) {
  StateVector state = StateVector::Zero();
  state.head<5>() << vx, vy, yaw_rate, ax, ay;
  return state;
}

TEST(MotionModel, KeepsTheSpeedOfASteadyTurn) {
  // A car on a circle: a = (0, r v) is what its turning needs, so v stays.
  const StateVector moved = Move(StateOf(10.0, 0.0, 0.8, 0.0, 8.0), 0.01);
  EXPECT_NEAR(moved[kVelocity], 10.0, 1e-3);
  EXPECT_NEAR(moved[kVelocity + 1], 0.0, 1e-3);
}

TEST(MotionModel, TurnsTheVelocityOfABodyWithoutForces) {
  // Seen from base, which turns by +r dt, the constant velocity turns by -r dt.
  StateVector state = StateOf(10.0, 0.0, 0.5);
  for (int i = 0; i < 100; ++i) state = Move(state, 0.01);
  EXPECT_NEAR(state[kVelocity], 10.0 * std::cos(0.5), 1e-3);
  EXPECT_NEAR(state[kVelocity + 1], -10.0 * std::sin(0.5), 1e-3);
}

TEST(MotionModel, MovesBackWhereItCameFrom) {
  const StateVector state = StateOf(9.0, -0.4, 1.1, 3.0, 7.0);
  EXPECT_TRUE(Move(Move(state, 0.05), -0.05).isApprox(state, 1e-3));
}

TEST(MotionModel, GivesEveryPointItsOwnVelocity) {
  const StateVector state = StateOf(5.0, 0.0, 2.0);
  EXPECT_TRUE(VelocityAt(state, {0.0, 0.6}).isApprox(Eigen::Vector2d(3.8, 0.0)));
  EXPECT_TRUE(VelocityAt(state, {-0.5, 0.0}).isApprox(Eigen::Vector2d(5.0, -1.0)));
}

TEST(MotionModel, RollsTheSteeredWheelsAlongTheirDirection) {
  Car car;
  car.front_axle = 0.7;
  car.rear_axle = 0.8;
  car.track_width = 1.2;
  const auto wheels = WheelGeometries(car, std::numbers::pi / 6.0);
  const StateVector state = StateOf(5.0, 1.0, 2.0);
  const Eigen::Vector2d front_left(5.0 - 2.0 * 0.6, 1.0 + 2.0 * 0.7);
  EXPECT_NEAR(HubSpeed(state, wheels[0]), front_left.dot(Eigen::Vector2d(std::sqrt(0.75), 0.5)),
              1e-12);
  EXPECT_NEAR(HubSpeed(state, wheels[3]), 5.0 + 2.0 * 0.6, 1e-12);
}

TEST(MotionModel, SlipChangesTheWheelSpeedInProportionAboveTheLeastSpeed) {
  EXPECT_NEAR(WheelSpeed(10.0, 0.1, 0.25, 2.0), 44.0, 1e-12);
  EXPECT_NEAR(WheelSpeed(0.0, 0.1, 0.25, 2.0), 0.8, 1e-12);
}

TEST(MotionModel, BoundsTheSlipByTorqueAndByBraking) {
  Car car;
  car.mass = 190.0;
  car.wheel_radius = 0.231;
  car.front_brake_share = 0.6;
  const SlipModel model({.sigma_free = 0.01,
                         .sigma_at_limit = 0.15,
                         .time_constant = 0.2,
                         .friction = 1.5,
                         .min_speed = 2.0},
                        kTyre, car);
  const Wheels free = model.Sigmas(Wheels{}, 0.0);
  EXPECT_DOUBLE_EQ(free[0], 0.01);
  const Wheels driven = model.Sigmas(Wheels{0.0, 0.0, 80.0, -80.0}, 0.0);
  EXPECT_DOUBLE_EQ(driven[0], 0.01);
  EXPECT_NEAR(driven[2], 0.01 + 0.15 * (80.0 / 0.231) / (1.5 * 190.0 * 9.81 / 4.0), 1e-12);
  EXPECT_DOUBLE_EQ(driven[2], driven[3]);
  const Wheels braked = model.Sigmas(Wheels{}, -8.0);
  EXPECT_NEAR(braked[0], 0.01 + 0.15 * (0.3 * 190.0 * 8.0) / (1.5 * 190.0 * 9.81 / 4.0), 1e-12);
  EXPECT_GT(braked[0], braked[2]);
  EXPECT_DOUBLE_EQ(model.Sigmas(Wheels{1e6, 0.0, 0.0, 0.0}, 0.0)[0], 0.16);
}

TEST(MotionModel, TakesTheDrivingForceFromTheAccelerationWhereNoTorqueIsMeasured) {
  Car car;
  car.mass = 190.0;
  car.wheel_radius = 0.231;
  car.front_brake_share = 0.6;
  const SlipModel model({.sigma_free = 0.01,
                         .sigma_at_limit = 0.15,
                         .time_constant = 0.2,
                         .friction = 1.5,
                         .min_speed = 2.0},
                        kTyre, car);
  const double torque = 190.0 * 6.0 / 4.0 * 0.231;
  const Wheels measured = model.Sigmas(Wheels{torque, torque, torque, torque}, 6.0);
  const Wheels unknown = model.Sigmas(std::nullopt, 6.0);
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(unknown[i], measured[i], 1e-12);
  EXPECT_EQ(model.Sigmas(std::nullopt, -8.0), model.Sigmas(Wheels{}, -8.0));
}

TEST(MotionModel, RollsTheFrontWheelsWhereTheirHubsGoIfNobodyKnowsTheAngle) {
  Car car;
  car.front_axle = 0.8;
  car.rear_axle = 0.7;
  car.track_width = 1.2;
  // A car that turns about a point on the line of its rear axle, 5 m to the left.
  StateVector state = StateVector::Zero();
  state << 5.0, 0.7, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0;
  const auto wheels = WheelGeometriesAlong(car, state);
  EXPECT_NEAR(HubSpeed(state, wheels[0]), std::hypot(5.0 - 0.6, 1.5), 1e-12);
  EXPECT_NEAR(HubSpeed(state, wheels[1]), std::hypot(5.0 + 0.6, 1.5), 1e-12);
  EXPECT_NEAR(HubSpeed(state, wheels[2]), 5.0 - 0.6, 1e-12);
  EXPECT_NEAR(HubSpeed(state, wheels[3]), 5.0 + 0.6, 1e-12);
}

TEST(MotionModel, InvertsTheTyreCurve) {
  const double b = kTyre.stiffness / (kTyre.shape * 1.5);
  for (const double angle : {-0.06, -0.01, 0.0, 0.02, 0.08}) {
    const double force_over_load = 1.5 * std::sin(kTyre.shape * std::atan(b * angle));
    EXPECT_NEAR(SlipAngle(9.81 * force_over_load, kTyre, 1.5), angle, 1e-12);
  }
  EXPECT_EQ(SlipAngle(100.0, kTyre, 1.5), SlipAngle(15.0, kTyre, 1.5)) << "level at the limit";
}

TEST(MotionModel, SlipsInTheMeanAsTheStiffnessSays) {
  const SlipModel model({.sigma_free = 0.01,
                         .sigma_at_limit = 0.15,
                         .time_constant = 0.2,
                         .friction = 1.5,
                         .min_speed = 2.0},
                        kTyre, Car());
  EXPECT_NEAR(model.Mean(-9.81), -1.0 / 20.0, 1e-12);
  EXPECT_EQ(model.Mean(0.0), 0.0);
}

TEST(MotionModel, SeesNoSlideWhereTheRearTyresSlipAsTheyMust) {
  VelocityEstimatorParams params;
  params.car.rear_axle = 0.7;
  params.tyre = kTyre;
  params.slip.friction = 1.5;
  StateVector state = StateVector::Zero();
  const double angle = SlipAngle(8.0, kTyre, 1.5);
  state << 8.0, 0.7 * 1.0 - 8.0 * angle, 1.0, 0.0, 8.0, 0.0, 0.0, 0.0, 0.0;
  EXPECT_NEAR(RearAxleSlide(state, params), 0.0, 1e-12);
  state[kVelocity + 1] -= 0.5;
  EXPECT_NEAR(RearAxleSlide(state, params), -0.5, 1e-12);
}

TEST(MotionModel, ProcessNoiseKeepsTheSlipsStationary) {
  const double decay = 0.9;
  const StateMatrix noise = ProcessNoise({0.1, 0.5, 20.0}, {0.01, 0.02, 0.03, 0.04}, decay, 0.01);
  for (int i = 0; i < 4; ++i) {
    const double variance = 1e-4 * (i + 1) * (i + 1);
    EXPECT_NEAR(decay * decay * variance + noise(kSlip + i, kSlip + i), variance, 1e-15);
  }
}

TEST(MotionModel, TurnsTheGnssVelocityAndItsCovarianceIntoBase) {
  SensorNoise noise;
  noise.gnss_velocity = 0.01;
  noise.gnss_heading = 0.001;
  const GnssReading north{0, {0.0, 10.0}, {0.05, 0.2}, std::numbers::pi / 2.0, 0.01};
  EXPECT_TRUE(VelocityInBase(north).isApprox(Eigen::Vector2d(10.0, 0.0), 1e-9));
  const Eigen::Matrix2d covariance = CovarianceInBase(north, noise);
  EXPECT_NEAR(covariance(0, 0), 0.04, 1e-9);
  EXPECT_NEAR(covariance(1, 1), 0.0025 + std::pow(10.0 * 0.01, 2), 1e-9);
  EXPECT_NEAR(covariance(0, 1), 0.0, 1e-9);
}

}  // namespace
}  // namespace hairpin
