#include "daemons/mission_manager/mission_manager_node.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/node/mission_manager/mission_rig.hpp"

namespace hairpin {
namespace {

TEST_F(MissionManagerNodeTest, AnswersEachVehicle) {
  Run(2.0);
  EXPECT_EQ(states, 40);
}

TEST_F(MissionManagerNodeTest, DrivesOneLapStopsAndFinishes) {
  StartDriving();
  EXPECT_EQ(state->reason, "driving to the start line");
  EXPECT_EQ(state->laps_to_drive, 1);
  speed = 10.0;
  Run(1.0);
  EXPECT_EQ(state->reason, "driving lap 1 of 1");
  Run(18.9);
  EXPECT_EQ(state->lap, 0);
  EXPECT_FALSE(state->mission_finished);
  Run(0.8);
  EXPECT_EQ(state->lap, 1);
  EXPECT_TRUE(state->mission_finished);
  EXPECT_EQ(state->state, as_state_t::STATE_DRIVING);
  EXPECT_NEAR(state->distance_m, 207.0, 1.0);
  speed = 0.0;
  Run(0.4);
  EXPECT_EQ(state->state, as_state_t::STATE_DRIVING);
  Run(0.3);
  EXPECT_EQ(state->state, as_state_t::STATE_FINISHED);
}

TEST_F(MissionManagerNodeTest, CountsTenLapsOfATrackdriveAlsoWhenTheLocalisationIsLost) {
  vehicle.mission = vehicle_t::MISSION_TRACKDRIVE;
  phase = global_map_t::PHASE_LOCALISED;
  StartDriving();
  EXPECT_EQ(state->laps_to_drive, 10);
  speed = 10.0;
  Run(1.0);
  EXPECT_EQ(state->reason, "driving lap 1 of 10");
  phase = global_map_t::PHASE_LOST;
  Run(10 * 20.0 - 1.0);
  EXPECT_EQ(state->state, as_state_t::STATE_DRIVING);
  EXPECT_EQ(state->lap, 9);
  EXPECT_FALSE(state->mission_finished);
  Run(1.0);
  EXPECT_EQ(state->lap, 10);
  EXPECT_TRUE(state->mission_finished);
}

TEST_F(MissionManagerNodeTest, CountsALapByTheMapWhereDeadReckoningDrifts) {
  vehicle.mission = vehicle_t::MISSION_TRACKDRIVE;
  phase = global_map_t::PHASE_LOCALISED;
  gates.clear();
  yaw_rate_error = 0.02;  // 20 m and more off after a lap
  StartDriving();
  speed = 10.0;
  Run(20.0);
  EXPECT_EQ(state->lap, 0);
  Run(1.0);  // the line at 206 m and 1.5 m of overrun
  EXPECT_EQ(state->lap, 1);
}

TEST_F(MissionManagerNodeTest, ResStopWhileDrivingIsAnEmergencyForGood) {
  StartDriving();
  speed = 10.0;
  Run(2.0);
  vehicle.res_stop = 1;
  Run(0.05);
  EXPECT_EQ(state->state, as_state_t::STATE_EMERGENCY);
  vehicle.res_stop = 0;
  speed = 0.0;
  Run(2.0);
  EXPECT_EQ(state->state, as_state_t::STATE_EMERGENCY);
}

TEST_F(MissionManagerNodeTest, RefusesOtherMissionsByName) {
  const std::pair<int32_t, const char*> missions[] = {
      {vehicle_t::MISSION_SKIDPAD, "skidpad"}, {vehicle_t::MISSION_INSPECTION, "inspection"}};
  for (const auto& [number, name] : missions) {
    vehicle.mission = number;
    Run(0.1);
    EXPECT_EQ(state->reason, std::string("mission ") + name + " cannot be driven yet");
  }
  vehicle.mission = vehicle_t::MISSION_SKIDPAD;
  Run(4.0);
  EXPECT_EQ(state->state, as_state_t::STATE_OFF);
  EXPECT_EQ(state->reason, "mission skidpad cannot be driven yet");
  EXPECT_EQ(state->mission, vehicle_t::MISSION_SKIDPAD);
  vehicle.mission = vehicle_t::MISSION_UNKNOWN;
  Run(0.1);
  EXPECT_EQ(state->reason, "no mission is selected");
}

TEST_F(MissionManagerNodeTest, DrivesAnAccelerationFromGateToGateStopsAndFinishes) {
  vehicle.mission = vehicle_t::MISSION_ACCELERATION;
  straight = true;
  gates = {1.7, 76.7};
  StartDriving();
  EXPECT_EQ(state->laps_to_drive, 1);
  speed = 10.0;
  Run(7.5);
  EXPECT_EQ(state->reason, "driving lap 1 of 1");
  EXPECT_FALSE(state->mission_finished);
  Run(0.3);
  EXPECT_TRUE(state->mission_finished);
  speed = 0.0;
  Run(0.7);
  EXPECT_EQ(state->state, as_state_t::STATE_FINISHED);
}

TEST_F(MissionManagerNodeTest, LeavesTheCarToTheDriver) {
  vehicle.mission = vehicle_t::MISSION_MANUAL;
  Run(4.0);
  EXPECT_EQ(state->state, as_state_t::STATE_OFF);
  EXPECT_EQ(state->reason, "mission manual: the master switch is on");
  vehicle.master_switch_on = 0;
  vehicle.ebs_state = vehicle_t::EBS_UNAVAILABLE;
  Run(0.1);
  EXPECT_EQ(state->state, as_state_t::STATE_MANUAL) << state->reason;
  vehicle.brakes_engaged = 0;
  speed = 10.0;
  vehicle.res_go = 1;
  Run(10.0);
  EXPECT_EQ(state->state, as_state_t::STATE_MANUAL);
  vehicle.tractive_system_on = 0;
  Run(0.1);
  EXPECT_EQ(state->state, as_state_t::STATE_OFF);
}

TEST_F(MissionManagerNodeTest, StopsTheMissionWhereAnotherIsSelectedOnTheWay) {
  StartDriving();
  speed = 10.0;
  Run(2.0);
  vehicle.mission = vehicle_t::MISSION_TRACKDRIVE;
  Run(0.05);
  EXPECT_EQ(state->state, as_state_t::STATE_OFF);
  EXPECT_EQ(state->reason, "the mission was changed");
}

TEST_F(MissionManagerNodeTest, CountsTheNextMissionFromItsOwnStart) {
  StartDriving();
  speed = 10.0;
  Run(20.7);
  EXPECT_EQ(state->lap, 1);
  speed = 0.0;
  Run(1.0);
  EXPECT_EQ(state->state, as_state_t::STATE_FINISHED);
  vehicle.master_switch_on = 0;
  vehicle.ebs_state = vehicle_t::EBS_UNAVAILABLE;
  Run(0.1);
  EXPECT_EQ(state->state, as_state_t::STATE_OFF);
  vehicle.master_switch_on = vehicle.brakes_engaged = 1;
  vehicle.ebs_state = vehicle_t::EBS_ARMED;
  Run(0.1);
  EXPECT_EQ(state->state, as_state_t::STATE_READY) << state->reason;
  EXPECT_EQ(state->lap, 0);
  EXPECT_FALSE(state->mission_finished);
  EXPECT_EQ(state->distance_m, 0.0);
}

TEST_F(MissionManagerNodeTest, CountsWhatItRefuses) {
  Run(1.0);
  others.Publish(channels::kVehicle, vehicle);  // the same time again
  velocity_t velocity{};
  velocity.utime = utime;
  velocity.valid = 1;
  others.Publish(channels::kVelocity, velocity);
  velocity.utime = utime + 5'000;
  velocity.vx_mps = 1e6;
  others.Publish(channels::kVelocity, velocity);
  local_map_t map{};
  map.utime = utime - 5'000'000;
  others.Publish(channels::kLocalMap, map);
  status.utime -= 40'000;
  others.Publish(channels::kPipelineStatus, status);
  const int before = states;
  transport.Drain();
  EXPECT_EQ(states, before);
  for (const channel_health_t& health : bus.Health()) {
    const int64_t expected = health.channel == "VELOCITY" ? 2
                             : health.channel == "VEHICLE" || health.channel == "LOCAL_MAP" ||
                                     health.channel == "PIPELINE_STATUS"
                                 ? 1
                                 : 0;
    // The first local map came before any velocity of its time.
    const int64_t early = health.channel == "LOCAL_MAP" ? 1 : 0;
    EXPECT_EQ(health.refused, expected + early) << health.channel;
  }
}

TEST(LoadMissionManagerParams, NamesEveryProblem) {
  const Config config = Config::FromText(
      "go_delay_s: -1\nready_after: 1.0\nneeded_channels: [IMU, TRAK]\n", "x.yaml");
  try {
    LoadMissionManagerParams(config);
    FAIL();
  } catch (const ConfigError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("go_delay_s"), std::string::npos);
    EXPECT_NE(what.find("needed_channels: `TRAK` is unknown (did you mean TRACK?)"),
              std::string::npos);
    EXPECT_NE(what.find("did you mean ready_after_s?"), std::string::npos);
    EXPECT_NE(what.find("autocross_laps: is missing"), std::string::npos);
  }
}

}  // namespace
}  // namespace hairpin
