#include "tools/simulator/vehicle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/support/simulator_setup.hpp"

namespace hairpin {
namespace {

constexpr double kGravity = 9.81;
constexpr int kStepsPerSecond = 1000;

Vehicle MakeVehicle(double speed = 0.0, const Pose2& start = {}) {
  return Vehicle(ShippedSimulatorParams().vehicle, ShippedCar(), start, speed);
}

VehicleInput AllWheels(double torque, double steering_angle = 0.0) {
  VehicleInput input;
  input.wheel_torque.fill(torque);
  input.steering_angle = steering_angle;
  return input;
}

VehicleInput Brake(double brake) {
  VehicleInput input;
  input.brake = brake;
  return input;
}

// Holds `speed` with a proportional controller for `seconds`.
void Cruise(Vehicle& vehicle, double speed, double steering_angle, double seconds) {
  for (int i = 0; i < static_cast<int>(seconds * 100.0); ++i) {
    vehicle.Advance(AllWheels(100.0 * (speed - vehicle.state().velocity.vx) + 15.0, steering_angle),
                    10);
  }
}

double WheelPower(const VehicleState& state) {
  return std::inner_product(state.wheel_torque.begin(), state.wheel_torque.end(),
                            state.wheel_speed.begin(), 0.0);
}

TEST(Vehicle, CoastsStraightOn) {
  Vehicle vehicle = MakeVehicle(15.0);
  vehicle.Advance({}, 2 * kStepsPerSecond);
  EXPECT_NEAR(vehicle.state().T_map_base.y, 0.0, 1e-9);
  EXPECT_NEAR(vehicle.state().T_map_base.yaw, 0.0, 1e-9);
  EXPECT_GT(vehicle.state().T_map_base.x, 25.0);
}

TEST(Vehicle, IsSlowedByDragAndRollingResistance) {
  const VehicleParams params = ShippedSimulatorParams().vehicle;
  const Car car = ShippedCar();
  Vehicle vehicle = MakeVehicle(15.0);
  vehicle.Advance({}, kStepsPerSecond / 2);  // the tyres have settled
  const double before = vehicle.state().velocity.vx;
  vehicle.Advance({}, kStepsPerSecond / 2);
  const double after = vehicle.state().velocity.vx;
  const double mean = 0.5 * (before + after);
  const double weight = car.mass * kGravity;
  const double rolling =
      params.rolling_resistance_n * (weight + params.downforce_ns2pm2 * mean * mean) / weight;
  const double spinning_mass =
      4.0 * params.wheel_inertia_kgm2 / (car.wheel_radius * car.wheel_radius);
  const double expected = (rolling + params.drag_ns2pm2 * mean * mean) / (car.mass + spinning_mass);
  EXPECT_NEAR((before - after) / 0.5, expected, 0.02 * expected);
}

TEST(Vehicle, TurnsKinematicallyWhenSlow) {
  const Car car = ShippedCar();
  Vehicle vehicle = MakeVehicle(2.0);
  Cruise(vehicle, 2.0, 0.2, 4.0);
  const Twist2& v = vehicle.state().velocity;
  EXPECT_NEAR(v.yaw_rate, v.vx * std::tan(0.2) / car.wheelbase(), 0.05 * v.yaw_rate);
  // Base moves across where the rear axle only rolls: v_y = r l_r.
  EXPECT_NEAR(v.vy, v.yaw_rate * car.rear_axle, 0.02);
}

TEST(Vehicle, CornersAtTheLimitOfFrictionAndNotBeyond) {
  const VehicleParams params = ShippedSimulatorParams().vehicle;
  Vehicle vehicle = MakeVehicle(14.0);
  Cruise(vehicle, 14.0, 0.25, 3.0);
  const double grip = params.tyre.peak_friction *
                      (kGravity + params.downforce_ns2pm2 * 14.0 * 14.0 / ShippedCar().mass);
  EXPECT_GT(vehicle.state().acceleration.y(), 0.75 * grip);
  EXPECT_LT(vehicle.state().acceleration.norm(), grip);
}

TEST(Vehicle, MirroredSteeringGivesMirroredMotion) {
  Vehicle left = MakeVehicle(8.0);
  Vehicle right = MakeVehicle(8.0);
  left.Advance(AllWheels(30.0, 0.15), kStepsPerSecond);
  right.Advance(AllWheels(30.0, -0.15), kStepsPerSecond);
  EXPECT_GT(left.state().T_map_base.y, 1.0);
  EXPECT_NEAR(left.state().T_map_base.x, right.state().T_map_base.x, 1e-9);
  EXPECT_NEAR(left.state().T_map_base.y, -right.state().T_map_base.y, 1e-9);
  EXPECT_NEAR(left.state().velocity.yaw_rate, -right.state().velocity.yaw_rate, 1e-9);
}

TEST(Vehicle, MovesAlikeWhereverItStarts) {
  const Pose2 start{30.0, -20.0, 2.5};
  Vehicle here = MakeVehicle(8.0);
  Vehicle there = MakeVehicle(8.0, start);
  here.Advance(AllWheels(30.0, 0.15), kStepsPerSecond);
  there.Advance(AllWheels(30.0, 0.15), kStepsPerSecond);
  const Pose2 expected = start * here.state().T_map_base;
  EXPECT_NEAR(there.state().T_map_base.x, expected.x, 1e-9);
  EXPECT_NEAR(there.state().T_map_base.y, expected.y, 1e-9);
  EXPECT_NEAR(WrapAngle(there.state().T_map_base.yaw - expected.yaw), 0.0, 1e-9);
}

TEST(Vehicle, StopsFromFullBrakeWithinWhatFrictionAllows) {
  const double speed = 15.0;
  Vehicle vehicle = MakeVehicle(speed);
  vehicle.Advance(Brake(1.0), 4 * kStepsPerSecond);
  const double energy = 0.5 * speed * speed;
  EXPECT_NEAR(vehicle.state().velocity.vx, 0.0, 1e-3);
  EXPECT_LT(vehicle.state().distance, energy / 8.0);  // the rules ask for 8 m/s^2 and more
  EXPECT_GT(vehicle.state().distance, energy / (1.2 * 1.6 * kGravity));
}

TEST(Vehicle, StandsStillWithAndWithoutBrakes) {
  for (const double brake : {0.0, 1.0}) {
    Vehicle vehicle = MakeVehicle();
    vehicle.Advance(Brake(brake), 10 * kStepsPerSecond);
    EXPECT_EQ(vehicle.state().distance, 0.0);
    EXPECT_EQ(vehicle.state().velocity.vx, 0.0);
  }
}

TEST(Vehicle, ComesBackToATrueStandstill) {
  Vehicle vehicle = MakeVehicle(6.0);
  vehicle.Advance(AllWheels(0.0, 0.3), kStepsPerSecond / 2);
  VehicleInput input = Brake(0.5);
  input.steering_angle = 0.3;
  vehicle.Advance(input, 6 * kStepsPerSecond);
  const Pose2 stopped = vehicle.state().T_map_base;
  vehicle.Advance(input, 20 * kStepsPerSecond);
  EXPECT_LT((vehicle.state().T_map_base.position() - stopped.position()).norm(), 1e-6);
  EXPECT_LT(std::abs(vehicle.state().velocity.vx), 1e-6);
  EXPECT_LT(std::abs(vehicle.state().velocity.yaw_rate), 1e-6);
  for (const double speed : vehicle.state().wheel_speed) EXPECT_EQ(speed, 0.0);
}

TEST(Vehicle, BrakesHoldAgainstTheMotors) {
  Vehicle vehicle = MakeVehicle();
  vehicle.Advance(Brake(1.0), kStepsPerSecond);
  VehicleInput input = AllWheels(150.0);
  input.brake = 1.0;
  vehicle.Advance(input, 3 * kStepsPerSecond);
  EXPECT_LT(vehicle.state().T_map_base.position().norm(), 0.01);
  EXPECT_LT(std::abs(vehicle.state().velocity.vx), 1e-6);
}

TEST(Vehicle, RegenerationStopsTheCarAndDoesNotReverseIt) {
  Vehicle vehicle = MakeVehicle(5.0);
  double slowest = 5.0;
  for (int i = 0; i < 500; ++i) {
    vehicle.Advance(AllWheels(-100.0), 10);
    slowest = std::min(slowest, vehicle.state().velocity.vx);
  }
  EXPECT_LT(vehicle.state().velocity.vx, 0.01);
  EXPECT_GT(slowest, -0.05);
}

TEST(Vehicle, ReachesThirtyMetresASecondAndStopsAgain) {
  Vehicle vehicle = MakeVehicle();
  Cruise(vehicle, 30.0, 0.0, 12.0);
  EXPECT_NEAR(vehicle.state().velocity.vx, 30.0, 1.0);
  EXPECT_NEAR(vehicle.state().T_map_base.y, 0.0, 1e-6);
  vehicle.Advance(Brake(0.6), 6 * kStepsPerSecond);
  EXPECT_LT(std::abs(vehicle.state().velocity.vx), 1e-6);
}

TEST(Vehicle, KeepsToTheMotorsTorqueAndPower) {
  const VehicleParams params = ShippedSimulatorParams().vehicle;
  const Car car = ShippedCar();
  Vehicle slow = MakeVehicle(1.0);
  slow.Advance(AllWheels(1e6), 100);
  for (const double torque : slow.state().wheel_torque) EXPECT_LE(torque, car.max_wheel_torque);
  Vehicle fast = MakeVehicle(25.0);
  for (int i = 0; i < 100; ++i) {
    fast.Advance(AllWheels(1e6), 10);
    // The wheels have spun on by one step since the limit was set.
    EXPECT_LE(WheelPower(fast.state()), 1.02 * params.max_motor_power_w);
  }
  EXPECT_GT(WheelPower(fast.state()), 0.95 * params.max_motor_power_w);
}

TEST(Vehicle, SteersAfterItsDelayAtItsRate) {
  const VehicleParams params = ShippedSimulatorParams().vehicle;
  Vehicle vehicle = MakeVehicle();
  const int delay = static_cast<int>(std::lround(params.steering_delay_s / Vehicle::kStep));
  vehicle.Advance(AllWheels(0.0, 0.3), delay);
  EXPECT_EQ(vehicle.state().steering_angle, 0.0);
  vehicle.Advance(AllWheels(0.0, 0.3), 100);
  EXPECT_NEAR(vehicle.state().steering_angle, 0.1 * params.steering_rate_radps, 1e-9);
  vehicle.Advance(AllWheels(0.0, 3.0), kStepsPerSecond);
  EXPECT_EQ(vehicle.state().steering_angle, ShippedCar().max_steering_angle);
}

TEST(Vehicle, MovesLoadForwardWhenItBrakesAndOutwardWhenItTurns) {
  const Car car = ShippedCar();
  Vehicle braking = MakeVehicle(15.0);
  braking.Advance(Brake(0.2), 300);
  const auto& load = braking.state().wheel_load;
  const double transfer =
      -braking.state().acceleration.x() * car.mass * car.cog_height / car.wheelbase();
  const double static_front = car.mass * kGravity * car.rear_axle / car.wheelbase();
  EXPECT_GT(transfer, 50.0);
  EXPECT_GT(load[0] + load[1], static_front + 0.9 * transfer);
  Vehicle turning = MakeVehicle(8.0);
  Cruise(turning, 8.0, 0.1, 2.0);
  EXPECT_GT(turning.state().wheel_load[1], turning.state().wheel_load[0] + 50.0);
  EXPECT_GT(turning.state().wheel_load[3], turning.state().wheel_load[2] + 50.0);
}

TEST(Vehicle, RefusesParametersThatCannotBe) {
  VehicleParams params = ShippedSimulatorParams().vehicle;
  params.wheel_inertia_kgm2 = 0.0;
  EXPECT_THROW(Vehicle(params, ShippedCar(), {}), std::invalid_argument);
  params = ShippedSimulatorParams().vehicle;
  params.steering_delay_s = -0.1;
  EXPECT_THROW(Vehicle(params, ShippedCar(), {}), std::invalid_argument);
  params = ShippedSimulatorParams().vehicle;
  params.tyre.lateral_relaxation_m = std::nan("");
  EXPECT_THROW(Vehicle(params, ShippedCar(), {}), std::invalid_argument);
}

TEST(Tyre, LosesFrictionAsItsLoadGrows) {
  const TyreParams params = ShippedSimulatorParams().vehicle.tyre;
  const Tyre tyre(params, 500.0);
  EXPECT_DOUBLE_EQ(tyre.Friction(500.0), params.peak_friction);
  EXPECT_DOUBLE_EQ(tyre.Friction(1000.0), params.peak_friction * (1.0 - params.load_sensitivity));
}

TEST(Tyre, SharesItsGripBetweenDrivingAndCornering) {
  const TyreParams params = ShippedSimulatorParams().vehicle.tyre;
  Tyre cornering(params, 500.0);
  Tyre both(params, 500.0);
  for (int i = 0; i < 200; ++i) {
    cornering.Step({0.0, 1.0}, 10.0, 1e-3);
    both.Step({1.0, 1.0}, 10.0, 1e-3);
  }
  EXPECT_LT(both.Force(500.0).y(), cornering.Force(500.0).y());
  EXPECT_LE(both.Force(500.0).norm(), params.peak_friction * 500.0);
}

}  // namespace
}  // namespace hairpin
