#include "daemons/path_tracker/wheel_forces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/unit/path_tracker/closed_loop.hpp"

namespace hairpin {
namespace {

double TotalForce(const Actuation& actuation, const Car& car) {
  double force = -actuation.brake * car.max_brake_force;
  for (const double torque : actuation.wheel_torque) force += torque / car.wheel_radius;
  return force;
}

TEST(WheelForces, TogetherGiveTheAccelerationAgainstDragAndRolling) {
  const PathTrackerParams params = test::ShippedParams();
  const WheelForces forces(params.forces, params.car);
  for (const double acceleration : {5.0, 1.0, 0.0, -0.5, -3.0, -6.0, -9.0}) {
    for (const double speed : {0.5, 3.0, 12.0}) {
      const Actuation actuation = forces.Distribute(acceleration, speed);
      const double wanted = 190.0 * acceleration + 0.7 * speed * speed + 180.0;
      EXPECT_NEAR(TotalForce(actuation, params.car), wanted, 60.0) << acceleration << " " << speed;
      EXPECT_EQ(actuation.wheel_torque[0], actuation.wheel_torque[1]);
      EXPECT_EQ(actuation.wheel_torque[2], actuation.wheel_torque[3]);
    }
  }
}

TEST(WheelForces, ShareByLoadSoThatNoAxleUsesMoreGripThanTheOther) {
  const PathTrackerParams params = test::ShippedParams();
  const Car& car = params.car;
  const WheelForces forces(params.forces, car);
  for (const double acceleration : {5.0, 2.0, -4.0}) {
    const Actuation actuation = forces.Distribute(acceleration, 10.0);
    const double g = 9.81;
    const double front_load = (g * car.rear_axle - acceleration * car.cog_height) / car.wheelbase();
    const double rear_load = g - front_load;
    EXPECT_NEAR(actuation.wheel_torque[0] / front_load, actuation.wheel_torque[2] / rear_load,
                1e-9);
  }
}

TEST(WheelForces, RefuseWrongParameters) {
  const PathTrackerParams good = test::ShippedParams();
  WheelForcesParams params = good.forces;
  params.min_braking = -1.0;
  EXPECT_THROW(WheelForces(params, good.car), std::invalid_argument);
}

TEST(WheelForces, RegenerateFirstAndFadeOutTowardStandstill) {
  const PathTrackerParams params = test::ShippedParams();
  const WheelForces forces(params.forces, params.car);
  EXPECT_EQ(forces.Distribute(-4.0, 10.0).brake, 0.0);
  EXPECT_LT(forces.Distribute(-4.0, 10.0).wheel_torque[0], 0.0);
  EXPECT_GT(forces.Distribute(-9.0, 10.0).brake, 0.05);
  EXPECT_GT(forces.Distribute(-4.0, 0.1).brake, 0.08);
}

TEST(WheelForces, LeaveToSteeringWhatCorneringNeeds) {
  const PathTrackerParams params = test::ShippedParams();
  const WheelForces forces(params.forces, params.car);
  EXPECT_EQ(forces.WithinGrip(-9.0, 0.0), -9.0);
  EXPECT_NEAR(forces.WithinGrip(-10.0, 8.0), -std::sqrt(12.0 * 12.0 - 64.0), 1e-9);
  EXPECT_NEAR(forces.WithinGrip(-10.0, -8.0), -std::sqrt(12.0 * 12.0 - 64.0), 1e-9);
  EXPECT_EQ(forces.WithinGrip(-10.0, 20.0), -3.0);
  EXPECT_EQ(forces.WithinGrip(5.0, 12.0), 3.0);
}

}  // namespace
}  // namespace hairpin
