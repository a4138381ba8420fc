// Rows of FAULTS at the gateway: what it is fed is wrong, and what goes out on the bus is looked
// at. Ticks are 10 ms of car time.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/gateway_rig.hpp"

namespace hairpin {
namespace {

void ExpectSafe(const GatewayRig& rig) {
  EXPECT_FALSE(rig.heartbeat);
  EXPECT_FALSE(rig.front.enable);
  EXPECT_EQ(rig.front.left_nm, 0.0);
  EXPECT_EQ(rig.brake.level_percent, 100.0);
}

TEST(Row6, WithoutCommandsTheCarStopsByItsWheelSpeedsWithin100Milliseconds) {
  GatewayRig rig;
  rig.Drive();
  rig.commands_flow = false;
  rig.Run(11);
  EXPECT_EQ(rig.front.left_nm, 0.0);
  EXPECT_EQ(rig.brake.level_percent, 30.0);
  EXPECT_TRUE(rig.heartbeat) << "L2";
}

TEST(Row6, WithoutCommandsAndWheelSpeedsTheHeartbeatCeasesWithin100Milliseconds) {
  GatewayRig rig;
  rig.Drive();
  rig.commands_flow = rig.wheels_talk = false;
  rig.Run(11);
  ExpectSafe(rig);
}

TEST(Row24, WithoutMissionManagerTheHeartbeatCeasesForGood) {
  GatewayRig rig;
  rig.Drive();
  rig.mission_manager_lives = false;
  const int ticks = rig.TicksUntil([&rig] { return !rig.heartbeat; });
  EXPECT_GT(ticks, 15);
  EXPECT_LE(ticks, 21);
  EXPECT_EQ(rig.gateway.supervision().emergency(), "AS_STATE has ceased");
  ExpectSafe(rig);
  rig.mission_manager_lives = true;
  rig.Run(50);
  ExpectSafe(rig);
}

TEST(Row24, WithoutWatchdogTheHeartbeatCeasesForGood) {
  GatewayRig rig;
  rig.Drive();
  rig.watchdog_lives = false;
  EXPECT_LE(rig.TicksUntil([&rig] { return !rig.heartbeat; }), 21);
  EXPECT_EQ(rig.gateway.supervision().emergency(), "PIPELINE_STATUS has ceased");
  rig.watchdog_lives = true;
  rig.Run(50);
  ExpectSafe(rig);
}

TEST(Row24, AWatchdogThatAsksForItEndsTheHeartbeatAtOnce) {
  GatewayRig rig;
  rig.Drive();
  rig.emergency_asked = true;
  rig.Tick();
  ExpectSafe(rig);
}

TEST(Row29, BusOffEndsTheHeartbeatAtOnceAndForGood) {
  for (const CanState state : {CanState::kBusOff, CanState::kDown}) {
    GatewayRig rig;
    rig.Drive();
    rig.gateway.OnBus(state);
    rig.Tick();
    ExpectSafe(rig);
    rig.gateway.OnBus(CanState::kActive);
    rig.Run(50);
    ExpectSafe(rig);
  }
}

TEST(Row29, BusOffBeforeTheCarIsArmedPasses) {
  GatewayRig rig;
  rig.Run(30);
  rig.gateway.OnBus(CanState::kBusOff);
  rig.Run(5);
  EXPECT_FALSE(rig.heartbeat);
  rig.gateway.OnBus(CanState::kActive);
  rig.Run(5);
  EXPECT_TRUE(rig.heartbeat);
}

// A bad RES_STATUS, in one way after the other: held for one period, an emergency after three.
class Row30 : public testing::TestWithParam<std::pair<const char*, CanFrame (*)(CanFrame)>> {};

TEST_P(Row30, OneBadFrameIsRefusedThreePeriodsEndTheHeartbeat) {
  const auto [problem, spoil] = GetParam();
  GatewayRig rig;
  rig.Drive();
  rig.res_talks = false;
  const auto send_bad = [&] { rig.Send(spoil(rig.NextRes(rig.now))); };
  rig.Run(5);
  send_bad();
  EXPECT_TRUE(rig.heartbeat) << "held";
  EXPECT_EQ(rig.Refused(std::string("RES_STATUS: ") + problem), 1);
  const int ticks = rig.TicksUntil([&] {
    send_bad();
    return !rig.heartbeat;
  });
  EXPECT_LE(ticks, 12) << "three periods of 50 ms since the last good one";
  EXPECT_EQ(rig.gateway.supervision().emergency(), "RES_STATUS has ceased");
  ExpectSafe(rig);
}

CanFrame Resealed(CanFrame frame) {
  frame.data[frame.length - 1] = ProtectionOf(frame);
  return frame;
}

INSTANTIATE_TEST_SUITE_P(Ways, Row30,
                         testing::Values(std::pair(
                                             "length",
                                             +[](CanFrame frame) {
                                               frame.length = 4;
                                               return frame;
                                             }),
                                         std::pair(
                                             "checksum",
                                             +[](CanFrame frame) {
                                               frame.data[4] ^= 1u;
                                               return frame;
                                             }),
                                         std::pair(
                                             "range of RadioQuality",
                                             +[](CanFrame frame) {
                                               frame.data[2] |= 0xF0u;
                                               frame.data[3] |= 0x07u;
                                               return Resealed(frame);
                                             }),
                                         std::pair(
                                             "sample time far from the car's", +[](CanFrame frame) {
                                               frame.data[1] ^= 0x80u;
                                               return Resealed(frame);
                                             })));

TEST(Row30, ACounterThatStandsStillEndsTheHeartbeatToo) {
  GatewayRig rig;
  rig.Drive();
  rig.res_talks = false;
  const int ticks = rig.TicksUntil([&rig] {
    rig.Send(dbc::Pack(dbc::ResStatus{.sample_time = ToSampleTime(rig.now), .counter = 3}));
    return !rig.heartbeat;
  });
  EXPECT_GT(ticks, 10);
  EXPECT_LE(ticks, 22);
  EXPECT_GT(rig.Refused("RES_STATUS: counter repeats"), 5);
}

TEST(Row31, AFloodOfForeignFramesThatPassedChangesNothing) {
  GatewayRig rig;
  rig.Drive();
  for (int tick = 0; tick < 100; ++tick) {
    for (uint32_t i = 0; i < 50; ++i) rig.Send({0x600 + i, 8, {}});
    rig.Tick();
    ASSERT_TRUE(rig.heartbeat);
  }
  EXPECT_NEAR(rig.front.left_nm, 20.0, 0.02);
  EXPECT_EQ(rig.Refused("another frame: not in the database"), 5'000);
}

TEST(Row31, ABabblingUnitDoesNotDriveOutTheOthers) {
  GatewayRig rig;
  rig.Drive();
  for (int tick = 0; tick < 100; ++tick) {
    for (int i = 0; i < 50; ++i) rig.Send({dbc::SteeringCommand::kId, 8, {}});
    for (int i = 0; i < 50; ++i) rig.Send({dbc::VehicleStatus::kId, 5, {}});
    rig.Tick();
    ASSERT_TRUE(rig.heartbeat);
  }
}

TEST(Row32, ASteeringActuatorThatIsStuckStopsTheCarWithin300Milliseconds) {
  GatewayRig rig;
  rig.Drive();
  rig.steering_stuck = true;
  rig.command.steering_angle = -0.05;
  // From where the model of the actuator is out of tolerance, 80 ms on, 300 ms.
  const int ticks = rig.TicksUntil([&rig] { return rig.brake.level_percent > 0.0; });
  EXPECT_GT(ticks, 20);
  EXPECT_LE(ticks, 38);
  EXPECT_EQ(rig.gateway.supervision().stop(), "actuators disagree: steering");
  EXPECT_FALSE(rig.front.enable);
  EXPECT_TRUE(rig.heartbeat) << "L2";
}

TEST(Row32, ASteeringActuatorThatDivergesEndsTheHeartbeat) {
  GatewayRig rig;
  rig.Drive();
  rig.steering_stuck = true;
  rig.command.steering_angle = -0.4;
  EXPECT_LE(rig.TicksUntil([&rig] { return !rig.heartbeat; }), 45);
  EXPECT_EQ(rig.gateway.supervision().emergency(), "steering diverges");
}

TEST(Row32, MotorsThatGiveMoreThanAskedForStopTheCar) {
  GatewayRig rig;
  rig.Drive();
  rig.extra_torque = 100.0;
  EXPECT_LE(rig.TicksUntil([&rig] { return !rig.front.enable; }), 30);
  EXPECT_EQ(rig.gateway.supervision().stop(), "actuators disagree: motors");
  EXPECT_TRUE(rig.heartbeat);
}

TEST(Row32, ABrakeThatDoesNotComeEndsTheHeartbeat) {
  GatewayRig rig;
  rig.Drive();
  rig.brake_share = 0.0;
  rig.command = {0.1, {}, 0.9};
  EXPECT_LE(rig.TicksUntil([&rig] { return !rig.heartbeat; }), 45);
  EXPECT_EQ(rig.gateway.supervision().emergency(), "brake diverges");
}

TEST(Row32, AnActuatorThatFollowsIsNoFaultHoweverTheCarIsSteered) {
  GatewayRig rig;
  rig.Drive();
  for (int tick = 0; tick < 600; ++tick) {
    rig.command.steering_angle = 0.5 * std::sin(0.03 * tick);
    const double wave = std::sin(0.05 * tick);
    rig.command.wheel_torque.fill(wave > 0.0 ? 200.0 * wave : 100.0 * wave);
    rig.command.brake = std::max(0.0, -wave);
    rig.Tick();
    ASSERT_EQ(rig.gateway.supervision().stop(), "") << tick;
    ASSERT_TRUE(rig.heartbeat) << tick;
  }
}

}  // namespace
}  // namespace hairpin
