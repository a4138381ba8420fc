// What must be right before the car may become Ready.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/node/mission_manager/mission_rig.hpp"

namespace hairpin {
namespace {

TEST_F(MissionManagerNodeTest, IsReadyAfterThreeSecondsOfAllChannelsAndSaysWhyNotBefore) {
  Run(2.9);
  EXPECT_EQ(state->state, as_state_t::STATE_OFF);
  EXPECT_EQ(state->reason, "IMU has just begun");
  Run(0.3);
  EXPECT_EQ(state->state, as_state_t::STATE_READY) << state->reason;
}

TEST_F(MissionManagerNodeTest, IsNotReadyForATrackdriveBeforeTheCarIsLocalisedAndSaysWhy) {
  vehicle.mission = vehicle_t::MISSION_TRACKDRIVE;
  silent = {"GLOBAL_MAP"};
  Run(4.0);
  EXPECT_EQ(state->state, as_state_t::STATE_OFF);
  EXPECT_EQ(state->reason, "GLOBAL_MAP was never heard");
  silent.clear();
  Run(3.3);
  EXPECT_EQ(state->reason, "trackdrive: no map is loaded");
  phase = global_map_t::PHASE_LOST;
  Run(0.2);
  EXPECT_EQ(state->reason, "trackdrive: the car does not find itself on the map");
  phase = global_map_t::PHASE_LOCALISED;
  Run(0.2);
  EXPECT_EQ(state->state, as_state_t::STATE_READY);
  silent = {"GLOBAL_MAP"};
  Run(0.7);
  EXPECT_EQ(state->state, as_state_t::STATE_OFF);
  EXPECT_EQ(state->reason, "GLOBAL_MAP is stale");
}

TEST_F(MissionManagerNodeTest, IsNotReadyWithoutAMapModeOrWhileTheWatchdogAsksForAStop) {
  status.map_mode = pipeline_status_t::MODE_NONE;
  status.reason = "all silent";
  Run(4.0);
  EXPECT_EQ(state->reason, "no perception pipeline is live: all silent");
  status.map_mode = pipeline_status_t::MODE_FUSION;
  status.level = pipeline_status_t::LEVEL_CONTROLLED_STOP;
  Run(0.1);
  EXPECT_EQ(state->reason, "the watchdog asks for a stop: all silent");
  status.level = pipeline_status_t::LEVEL_LOG;
  Run(0.1);
  EXPECT_EQ(state->state, as_state_t::STATE_READY);
}

TEST_F(MissionManagerNodeTest, LosesReadyWithAChannelAndNamesIt) {
  Run(4.0);
  EXPECT_EQ(state->state, as_state_t::STATE_READY);
  silent = {"VELOCITY"};
  Run(0.2);
  EXPECT_EQ(state->state, as_state_t::STATE_OFF);
  EXPECT_EQ(state->reason, "VELOCITY is stale");
}

TEST_F(MissionManagerNodeTest, RefusesReadyWithADaemonOfAnotherBuild) {
  heartbeat_t heartbeat = HeartbeatOf("local_mapper");
  others.Publish(channels::kHeartbeat, heartbeat);
  Run(4.0);
  EXPECT_EQ(state->state, as_state_t::STATE_READY) << state->reason;
  heartbeat.types_hash += 1;
  heartbeat.utime = utime;
  others.Publish(channels::kHeartbeat, heartbeat);
  Run(0.1);
  EXPECT_EQ(state->reason, "local_mapper has other message types");
  heartbeat = HeartbeatOf("local_mapper");
  heartbeat.build += "-dirty";
  others.Publish(channels::kHeartbeat, heartbeat);
  Run(0.1);
  EXPECT_EQ(state->reason, "local_mapper is of another build");
  heartbeat = HeartbeatOf("local_mapper");
  heartbeat.car_hash += 1;
  others.Publish(channels::kHeartbeat, heartbeat);
  Run(0.1);
  EXPECT_EQ(state->reason, "config: local_mapper has another car.yaml");
  others.Publish(channels::kHeartbeat, HeartbeatOf("local_mapper"));
  Run(0.1);
  EXPECT_EQ(state->state, as_state_t::STATE_READY) << state->reason;
}

TEST_F(MissionManagerNodeTest, RefusesReadyWithoutRoomForTheLogOrBuffersForTheScans) {
  host.free_disk_gb = 0.5;
  Run(4.0);
  EXPECT_EQ(state->state, as_state_t::STATE_OFF);
  EXPECT_EQ(state->reason, "disk: 0.5 GB free for /var/log/hairpin, less than 1.0 GB");
  host = {50.0, 212.992};
  Run(1.1);
  EXPECT_EQ(state->reason,
            "buffers: the kernel gives a socket 213 kB, less than 2000 kB (sysctl "
            "net.core.rmem_max)");
  host = {50.0, std::nullopt};  // memq
  Run(1.1);
  EXPECT_EQ(state->state, as_state_t::STATE_READY) << state->reason;
}

TEST_F(MissionManagerNodeTest, DoesNotLookAtADiskThatMayBeSlowWhileTheCarDrives) {
  StartDriving();
  speed = 10.0;
  Run(0.1);
  const int before = looks;
  EXPECT_GE(before, 9);
  host.free_disk_gb = 0.0;
  Run(5.0);
  EXPECT_EQ(looks, before);
  EXPECT_EQ(state->state, as_state_t::STATE_DRIVING);
}

TEST_F(MissionManagerNodeTest, RefusesReadyWithASensorWhoseClockIsNotTheOthers) {
  silent = {"GROUND_SPEED"};
  for (int i = 0; i < 400; ++i) {
    Tick();
    ground_speed_t message{};
    message.utime = utime - 70'000;
    others.Publish(channels::kGroundSpeed, message);
  }
  EXPECT_EQ(state->state, as_state_t::STATE_OFF);
  EXPECT_EQ(state->reason, "the clock of GROUND_SPEED is 70 ms behind the others");
}

TEST_F(MissionManagerNodeTest, TellsPeopleAllThatIsWrongWhileItIsOffAndOnceWhereItLosesAState) {
  silent = {"TRACK", "GNSS"};
  host.free_disk_gb = 0.5;
  testing::internal::CaptureStderr();
  Run(4.9);
  EXPECT_EQ(testing::internal::GetCapturedStderr().find("AS "), std::string::npos);
  testing::internal::CaptureStderr();
  Run(10.0);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "mission_manager: AS Off: GNSS was never heard; TRACK was never heard; disk: 0.5 GB "
            "free for /var/log/hairpin, less than 1.0 GB\n");
  silent.clear();
  host.free_disk_gb = 50.0;
  Run(4.0);
  EXPECT_EQ(state->state, as_state_t::STATE_READY) << state->reason;
  vehicle.res_stop = 1;
  testing::internal::CaptureStderr();
  Run(10.0);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "mission_manager: AS Emergency: stopped by the RES\n");
}

}  // namespace
}  // namespace hairpin
