#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/gateway_rig.hpp"

namespace hairpin {
namespace {

TEST(CanGateway, PassesCommandsWhileDriving) {
  GatewayRig rig;
  rig.Drive();
  rig.Tick();
  EXPECT_EQ(rig.refusal, "");
  EXPECT_TRUE(rig.front.enable && rig.steering.enable);
  EXPECT_NEAR(rig.front.left_nm, 20.0, 0.02);
  EXPECT_NEAR(rig.steering.angle_rad, 0.1, 1e-4);
  EXPECT_EQ(rig.brake.level_percent, 0.0);
  EXPECT_TRUE(rig.heartbeat);
  EXPECT_EQ(rig.steering.command_time, ToSampleTime(rig.now));
  EXPECT_EQ(rig.status.as_state, as_state_t::STATE_DRIVING);
  EXPECT_EQ(rig.frames, 6) << "one cycle a command, and the logger's frames at 10 Hz";
}

TEST(CanGateway, RefusesToMoveTheCarUnlessAsIsDriving) {
  for (const int state :
       std::vector<int>{as_state_t::STATE_OFF, as_state_t::STATE_READY, as_state_t::STATE_EMERGENCY,
                        as_state_t::STATE_FINISHED}) {
    GatewayRig rig;
    rig.state = state;
    rig.moves = true;
    rig.Run(50);
    EXPECT_EQ(rig.refusal, "AS is not Driving");
    EXPECT_FALSE(rig.front.enable || rig.steering.enable);
    EXPECT_EQ(rig.front.left_nm, 0.0);
    EXPECT_GE(rig.brake.level_percent, 50.0);
  }
}

TEST(CanGateway, RefusesCommandsByName) {
  GatewayRig rig;
  EXPECT_EQ(rig.gateway.OnCommand({rig.now, true, {}, 0.0}, rig.wall),
            "the bus has told no time yet");
  rig.Drive();
  const auto refusal = [&rig](int64_t offset, DriveOrder order = {}) {
    return rig.gateway.OnCommand({rig.now + offset, true, order, 0.0}, rig.wall);
  };
  EXPECT_EQ(refusal(0), "its time does not rise");
  EXPECT_EQ(refusal(201'000), "its time lies in the future");
  EXPECT_EQ(refusal(1'000, {std::nan(""), {}, 0.0}), "a value is not finite");
  rig.commands_flow = false;
  rig.Run(13);
  EXPECT_EQ(refusal(-101'000), "too old");
}

// The edges of the deadman, in car time: ticks of 10 ms after the last command.
TEST(CanGateway, HoldsThenFreesThenFallsSilentWithoutCommands) {
  GatewayRig rig;
  rig.Drive();
  rig.commands_flow = false;
  rig.Run(5);
  EXPECT_EQ(rig.status.deadman_stage, 0) << "50 ms";
  rig.Run(1);
  EXPECT_EQ(rig.status.deadman_stage, 1) << "60 ms: held";
  EXPECT_NEAR(rig.front.left_nm, 20.0, 0.02);
  EXPECT_TRUE(rig.front.enable);
  EXPECT_NE(rig.front.command_time, ToSampleTime(rig.now)) << "a held order is as old as it is";
  rig.Run(4);
  EXPECT_EQ(rig.status.deadman_stage, 1) << "100 ms";
  rig.Run(1);
  EXPECT_EQ(rig.status.deadman_stage, 2) << "110 ms: neutral";
  EXPECT_EQ(rig.front.left_nm, 0.0);
  EXPECT_FALSE(rig.front.enable);
  EXPECT_EQ(rig.brake.level_percent, 30.0);
  EXPECT_NEAR(rig.steering.angle_rad, 0.1, 1e-4) << "steering stays";
  EXPECT_TRUE(rig.steering.enable);
  rig.Run(9);
  EXPECT_TRUE(rig.heartbeat) << "200 ms";
  rig.Run(1);
  EXPECT_FALSE(rig.heartbeat) << "210 ms";
  EXPECT_EQ(rig.gateway.supervision().emergency(), "commands have ceased");
  EXPECT_EQ(rig.status.as_state, as_state_t::STATE_EMERGENCY);
  EXPECT_EQ(rig.brake.level_percent, 100.0);
}

TEST(CanGateway, DrivesOnWhenCommandsComeBackInTime) {
  GatewayRig rig;
  rig.Drive();
  rig.commands_flow = false;
  rig.Run(18);
  rig.commands_flow = true;
  rig.Run(10);
  EXPECT_EQ(rig.gateway.supervision().emergency(), "");
  EXPECT_TRUE(rig.heartbeat);
  EXPECT_NEAR(rig.front.left_nm, 20.0, 0.02);
}

TEST(CanGateway, NeverArmsAgainByItself) {
  GatewayRig rig;
  rig.Drive();
  rig.commands_flow = false;
  rig.Run(30);
  rig.commands_flow = true;
  rig.Run(50);
  rig.state = as_state_t::STATE_OFF;
  rig.Run(50);
  EXPECT_FALSE(rig.heartbeat);
  EXPECT_EQ(rig.front.left_nm, 0.0);
}

TEST(CanGateway, GivesNoHeartbeatWhereItFindsTheCarDriving) {
  GatewayRig rig;
  rig.state = as_state_t::STATE_DRIVING;
  rig.moves = true;
  rig.Run(50);
  EXPECT_FALSE(rig.heartbeat);
  EXPECT_EQ(rig.front.left_nm, 0.0);
  EXPECT_EQ(rig.gateway.supervision().emergency(), "the car drove when this daemon started");
}

TEST(CanGateway, HasItsHeartbeatInOffOnlyWhileBothSuperviseIt) {
  GatewayRig rig;
  rig.watchdog_lives = false;
  rig.Run(30);
  EXPECT_FALSE(rig.heartbeat);
  rig.watchdog_lives = true;
  rig.Run(30);
  EXPECT_TRUE(rig.heartbeat) << "not armed: nothing latches";
  rig.mission_manager_lives = false;
  rig.Run(30);
  EXPECT_FALSE(rig.heartbeat);
}

TEST(CanGateway, CountsInWallTimeOnASilentBus) {
  GatewayRig rig;
  rig.Drive();
  rig.car_talks = rig.car_time_runs = rig.commands_flow = false;
  const auto ceased = [&rig] { return !rig.gateway.supervision().emergency().empty(); };
  EXPECT_EQ(rig.TicksUntil(ceased), 11) << "110 ms of wall";
  EXPECT_EQ(rig.gateway.supervision().emergency(), "the CAN bus is silent");
  EXPECT_FALSE(rig.heartbeat);
  EXPECT_EQ(rig.front.left_nm, 0.0);
}

TEST(CanGateway, WaitsWithASimulatorWhoseTimeStandsStillForAWhile) {
  GatewayRig rig;
  rig.Drive();
  rig.car_time_runs = rig.commands_flow = false;
  rig.Run(45);  // frames flow, time does not
  EXPECT_EQ(rig.gateway.supervision().emergency(), "");
  rig.Run(10);
  EXPECT_NE(rig.gateway.supervision().emergency(), "") << "but not for ever";
}

TEST(CanGateway, TakesNoDrivingTorqueWhenTheWatchdogAsksForAStop) {
  GatewayRig rig;
  rig.Drive();
  rig.stop_asked = true;
  rig.Run(2);
  EXPECT_EQ(rig.front.left_nm, 0.0);
  EXPECT_TRUE(rig.heartbeat);
}

TEST(CanGateway, SaysFarewellNeutralAndWithoutHeartbeat) {
  GatewayRig rig;
  rig.Drive();
  const std::vector<CanFrame> frames = rig.gateway.Farewell(rig.wall);
  ASSERT_EQ(frames.size(), 4u);
  dbc::TorqueCommandFront front;
  dbc::BrakeCommand brake;
  ASSERT_EQ(dbc::Unpack(frames[1], front), "");
  ASSERT_EQ(dbc::Unpack(frames[3], brake), "");
  EXPECT_FALSE(front.enable);
  EXPECT_EQ(front.left_nm, 0.0);
  EXPECT_EQ(brake.level_percent, 50.0);
}

TEST(CanGateway, LetsGoOfEveryActuatorWhereTheCarIsTheDrivers) {
  GatewayRig rig;
  rig.Run(50);
  EXPECT_TRUE(rig.brake.enable);
  rig.state = as_state_t::STATE_MANUAL;
  rig.moves = false;
  rig.Run(50);
  EXPECT_FALSE(rig.brake.enable || rig.steering.enable || rig.front.enable);
  EXPECT_EQ(rig.brake.level_percent, 0.0);
  EXPECT_EQ(rig.status.as_state, as_state_t::STATE_MANUAL);
  EXPECT_EQ(rig.gateway.supervision().emergency(), "");
  rig.mission_manager_lives = false;
  rig.Run(50);
  EXPECT_EQ(rig.gateway.supervision().emergency(), "") << "the circuit is not the computer's now";
  EXPECT_FALSE(rig.brake.enable);
}

TEST(CanGateway, TellsTheDataLoggerTenTimesASecond) {
  GatewayRig rig;
  rig.Drive();
  rig.gateway.OnCones(12, 150);
  rig.logger.clear();
  rig.Run(100);
  ASSERT_EQ(rig.logger.size(), 30u);
  dbc::DvDrivingDynamics1 dynamics;
  dbc::DvDrivingDynamics2 accelerations;
  dbc::DvSystemStatus status;
  ASSERT_EQ(dbc::Unpack(rig.logger[27], dynamics), "");
  ASSERT_EQ(dbc::Unpack(rig.logger[28], accelerations), "");
  ASSERT_EQ(dbc::Unpack(rig.logger[29], status), "");
  EXPECT_EQ(dynamics.speed_actual_kmph, 17) << "20 rad/s at 0.231 m";
  EXPECT_EQ(dynamics.speed_target_kmph, 18);
  EXPECT_EQ(dynamics.steering_target_deg, 5.5) << "0.1 rad in steps of half a degree";
  EXPECT_EQ(dynamics.motor_moment_target_percent, 7) << "20 of 280 N m";
  EXPECT_NEAR(accelerations.acceleration_longitudinal_mps2, 1.0, 1.0 / 512);
  EXPECT_NEAR(accelerations.yaw_rate_degps, 17.19, 1.0 / 128);
  EXPECT_EQ(status.as_status, 3);
  EXPECT_EQ(status.ebs_state, 2);
  EXPECT_EQ(status.mission, 6);
  EXPECT_EQ(status.lap_counter, 2);
  EXPECT_EQ(status.cones_count, 12);
  EXPECT_EQ(status.cones_count_all, 150u);
}

}  // namespace
}  // namespace hairpin
