#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/simulator_setup.hpp"
#include "tools/simulator/actuators.hpp"

namespace hairpin {
namespace {

constexpr int64_t kStart = 1'700'000'000'000'000;
constexpr int64_t kMillisecond = 1000;
constexpr double kMoving = 8.0;

Actuators MakeActuators() { return Actuators(ShippedSimulatorParams().actuators, ShippedCar()); }

as_state_t State(int64_t utime, int32_t state) {
  as_state_t message{};
  message.utime = utime;
  message.state = state;
  return message;
}

drive_command_t Command(int64_t utime) {
  drive_command_t message{};
  message.utime = utime;
  message.steering_angle_rad = 0.1;
  for (double& torque : message.wheel_torque_nm) torque = 50.0;
  return message;
}

// Driving, with a command at kStart and the state heard again lately, as it comes at 20 Hz.
VehicleInput ActAfter(Actuators& actuators, int64_t milliseconds) {
  EXPECT_EQ(actuators.OnState(State(kStart, as_state_t::STATE_DRIVING), kStart), "");
  EXPECT_EQ(actuators.OnCommand(Command(kStart), kStart), "");
  const int64_t now = kStart + milliseconds * kMillisecond;
  EXPECT_EQ(actuators.OnState(State(now, as_state_t::STATE_DRIVING), now), "");
  return actuators.Act(now, 0.1);
}

TEST(Actuators, ObeyAFreshCommand) {
  Actuators actuators = MakeActuators();
  const VehicleInput input = ActAfter(actuators, 49);
  EXPECT_EQ(actuators.deadman(), DeadmanStage::kFresh);
  EXPECT_EQ(actuators.held(), 0);
  EXPECT_EQ(input.wheel_torque[3], 50.0);
  EXPECT_EQ(input.steering_angle, 0.1);
  EXPECT_EQ(input.brake, 0.0);
}

TEST(Actuators, HoldACommandOlderThan50Milliseconds) {
  for (const int64_t age : {51, 99}) {
    Actuators actuators = MakeActuators();
    const VehicleInput input = ActAfter(actuators, age);
    EXPECT_EQ(actuators.deadman(), DeadmanStage::kHeld);
    EXPECT_EQ(actuators.held(), 1);
    EXPECT_EQ(input.wheel_torque[0], 50.0);
    EXPECT_EQ(input.brake, 0.0);
  }
}

TEST(Actuators, BrakeWithoutTorqueAfter100Milliseconds) {
  for (const int64_t age : {101, 199}) {
    Actuators actuators = MakeActuators();
    const VehicleInput input = ActAfter(actuators, age);
    EXPECT_EQ(actuators.deadman(), DeadmanStage::kNeutral);
    EXPECT_EQ(input.wheel_torque[0], 0.0);
    EXPECT_EQ(input.brake, ShippedSimulatorParams().actuators.deadman_brake);
    EXPECT_EQ(input.steering_angle, 0.1);
    EXPECT_FALSE(actuators.ebs_activated());
  }
}

TEST(Actuators, DriveOnWhenCommandsComeBackBefore200Milliseconds) {
  Actuators actuators = MakeActuators();
  ActAfter(actuators, 199);
  const int64_t now = kStart + 199 * kMillisecond;
  EXPECT_EQ(actuators.OnCommand(Command(now), now), "");
  EXPECT_EQ(actuators.Act(now, 0.1).wheel_torque[0], 50.0);
}

TEST(Actuators, BrakeForGoodAfter200Milliseconds) {
  Actuators actuators = MakeActuators();
  EXPECT_EQ(ActAfter(actuators, 201).brake, 1.0);
  EXPECT_TRUE(actuators.ebs_activated());
  EXPECT_FALSE(actuators.shutdown_circuit_closed());
  const int64_t later = kStart + 300 * kMillisecond;
  EXPECT_EQ(actuators.OnCommand(Command(later), later), "");
  EXPECT_EQ(actuators.Act(later, 0.1).brake, 1.0);
  EXPECT_EQ(actuators.Act(later, 0.1).wheel_torque[0], 0.0);
}

TEST(Actuators, CountFromTheStateWhereNoCommandHasComeYet) {
  Actuators actuators = MakeActuators();
  actuators.OnState(State(kStart, as_state_t::STATE_DRIVING), kStart);
  EXPECT_EQ(actuators.Act(kStart + 40 * kMillisecond, 0.0).brake, 0.0);
  EXPECT_GT(actuators.Act(kStart + 110 * kMillisecond, 0.0).brake, 0.0);
  EXPECT_FALSE(actuators.ebs_activated());
  actuators.Act(kStart + 210 * kMillisecond, 0.0);
  EXPECT_TRUE(actuators.ebs_activated());
}

TEST(Actuators, ParkUnlessDriving) {
  for (const int32_t state :
       std::initializer_list<int32_t>{as_state_t::STATE_OFF, as_state_t::STATE_READY}) {
    Actuators actuators = MakeActuators();
    actuators.OnState(State(kStart, state), kStart);
    actuators.OnCommand(Command(kStart), kStart);
    const VehicleInput input = actuators.Act(kStart + kMillisecond, 0.05);
    EXPECT_EQ(input.wheel_torque[0], 0.0);
    EXPECT_GT(input.brake, 0.0);
    EXPECT_EQ(input.steering_angle, 0.05);
    EXPECT_FALSE(actuators.ebs_activated());
  }
}

TEST(Actuators, SetTheEmergencyBrakeOnlyOnceTheMissionIsOver) {
  Actuators actuators = MakeActuators();
  as_state_t state = State(kStart, as_state_t::STATE_DRIVING);
  state.mission_finished = 1;
  actuators.OnState(state, kStart);
  actuators.OnCommand(Command(kStart), kStart);
  EXPECT_EQ(actuators.Act(kStart, 0.0).brake, 0.0);
  EXPECT_FALSE(actuators.ebs_activated());
  actuators.OnState(State(kStart + kMillisecond, as_state_t::STATE_FINISHED),
                    kStart + kMillisecond);
  EXPECT_EQ(actuators.Act(kStart + kMillisecond, 0.0).brake, 1.0);
  EXPECT_TRUE(actuators.ebs_activated());
  EXPECT_TRUE(actuators.shutdown_circuit_closed());
}

TEST(Actuators, BrakeInAnEmergencyAndOnTheRemoteStop) {
  Actuators emergency = MakeActuators();
  emergency.OnState(State(kStart, as_state_t::STATE_EMERGENCY), kStart);
  EXPECT_EQ(emergency.Act(kStart, 0.0).brake, 1.0);
  Actuators stopped = MakeActuators();
  stopped.OnState(State(kStart, as_state_t::STATE_DRIVING), kStart);
  stopped.OnCommand(Command(kStart), kStart);
  stopped.StopByRes();
  EXPECT_EQ(stopped.Act(kStart, 0.0).brake, 1.0);
  EXPECT_TRUE(stopped.res_stop());
}

TEST(Actuators, BrakeForGoodWhenTheStateCeasesToCome) {
  Actuators actuators = MakeActuators();
  actuators.OnState(State(kStart, as_state_t::STATE_DRIVING), kStart);
  for (int64_t ms = 0; ms <= 210; ms += 10) {
    const int64_t now = kStart + ms * kMillisecond;
    actuators.OnCommand(Command(now), now);
    actuators.Act(now, 0.0);
    EXPECT_EQ(actuators.ebs_activated(), ms > 200) << ms;
  }
}

TEST(Actuators, LimitWhatIsCommanded) {
  const Car car = ShippedCar();
  Actuators actuators = MakeActuators();
  actuators.OnState(State(kStart, as_state_t::STATE_DRIVING), kStart);
  drive_command_t command = Command(kStart);
  command.steering_angle_rad = -5.0;
  command.wheel_torque_nm[1] = -1e9;
  command.brake = 7.0;
  actuators.OnCommand(command, kStart);
  const VehicleInput input = actuators.Act(kStart, 0.0);
  EXPECT_EQ(input.steering_angle, -car.max_steering_angle);
  EXPECT_EQ(input.wheel_torque[1], -car.max_wheel_torque);
  EXPECT_EQ(input.brake, 1.0);
}

TEST(Actuators, RefuseCommandsOutOfTimeOrNotFinite) {
  Actuators actuators = MakeActuators();
  EXPECT_EQ(actuators.OnCommand(Command(kStart), kStart), "");
  EXPECT_NE(actuators.OnCommand(Command(kStart), kStart), "");
  EXPECT_NE(actuators.OnCommand(Command(kStart + kMillisecond), kStart), "");
  drive_command_t bad = Command(kStart + kMillisecond);
  bad.wheel_torque_nm[2] = std::nan("");
  EXPECT_NE(actuators.OnCommand(bad, kStart + kMillisecond), "");
  EXPECT_EQ(actuators.OnState(State(kStart, as_state_t::STATE_READY), kStart), "");
  EXPECT_NE(actuators.OnState(State(kStart - kMillisecond, as_state_t::STATE_DRIVING), kStart), "");
  EXPECT_EQ(actuators.state(), as_state_t::STATE_READY);
}

TEST(Actuators, RefuseParametersThatCannotBe) {
  ActuatorParams params = ShippedSimulatorParams().actuators;
  params.brake_after_s = 0.5 * params.hold_after_s;
  EXPECT_THROW(Actuators(params, ShippedCar()), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
