#include "daemons/mission_manager/mission_manager_node.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/daemon.hpp"

namespace hairpin {
namespace {

constexpr double kPi = std::numbers::pi;

// The rest of the car, standing or driving a 200 m lap whose gate is 6 m ahead of the start.
class MissionManagerNodeTest : public testing::Test {
 protected:
  MissionManagerNodeTest() {
    vehicle.mission = vehicle_t::MISSION_AUTOCROSS;
    vehicle.master_switch_on = vehicle.tractive_system_on = vehicle.shutdown_circuit_closed = 1;
    vehicle.brakes_engaged = vehicle.brakes_ok = 1;
    vehicle.ebs_state = vehicle_t::EBS_ARMED;
    status.map_mode = pipeline_status_t::MODE_FUSION;
    status.speed_cap_mps = 12.0;
    others.Subscribe(channels::kAsState, [this](const as_state_t& message) {
      EXPECT_EQ(message.utime, utime);
      state = message;
      ++states;
    });
  }

  template <class M>
  void Publish(const Channel<M>& channel, M message = {}) {
    if (silent.contains(channel.name)) return;
    message.utime = utime;
    others.Publish(channel, message);
  }

  void Tick() {
    utime += 10'000;
    ++tick;
    Publish(channels::kImu);
    Publish(channels::kGroundSpeed);
    Publish(channels::kMotors);
    Publish(channels::kSteering);
    if (tick % 10 == 0) Publish(channels::kGnss);
    truth = truth * Integrate({speed, 0.0, speed * Curvature()}, 0.01);
    distance += speed * 0.01;
    velocity_t velocity{};
    velocity.valid = 1;
    velocity.vx_mps = speed;
    velocity.yaw_rate_radps = speed * Curvature() + (speed > 0.0 ? yaw_rate_error : 0.0);
    Publish(channels::kVelocity, velocity);
    Publish(channels::kDriveCommand);
    if (tick % 2 == 0) {
      status.utime = utime;
      Publish(channels::kPipelineStatus, status);
    }
    if (tick % 10 == 0) PublishMapAndTrack();
    if (tick % 5 == 0) {
      vehicle.utime = utime;
      vehicle.speed_mps = speed;
      others.Publish(channels::kVehicle, vehicle);
    }
    transport.Drain();
  }

  void PublishMapAndTrack() {
    local_map_t map{};
    map.utime = utime - 100'000;
    const Pose2 then = truth * Integrate({speed, 0.0, speed * Curvature()}, -0.1);
    if (!silent.contains(channels::kGlobalMap.name)) {
      global_map_t global{};
      global.utime = utime - 100'000;
      global.phase = phase;
      const Pose2 T_map_base = Pose2{30.0, -4.0, 2.0} * then;  // as is the known map
      global.x_m = T_map_base.x;
      global.y_m = T_map_base.y;
      global.yaw_rad = T_map_base.yaw;
      others.Publish(channels::kGlobalMap, global);
    }
    const Pose2 T_local_map{5.0, 9.0, 1.0};  // the mapper's frame is its own
    const Pose2 T_local_base = T_local_map * then;
    map.x_m = T_local_base.x;
    map.y_m = T_local_base.y;
    map.yaw_rad = T_local_base.yaw;
    for (const double x : gates) {
      for (const double y : {1.7, -1.7}) map.cones.push_back(GateConeAt(T_local_map, {x, y}));
    }
    map.num_cones = static_cast<int32_t>(map.cones.size());
    if (!silent.contains(channels::kLocalMap.name)) others.Publish(channels::kLocalMap, map);
    track_t track{};
    track.utime = map.utime;
    if (!silent.contains(channels::kTrack.name)) others.Publish(channels::kTrack, track);
  }

  static local_cone_t GateConeAt(const Pose2& T_local_map, const Eigen::Vector2d& place) {
    const Eigen::Vector2d position = T_local_map * place;
    local_cone_t cone{};
    cone.x_m = position.x();
    cone.y_m = position.y();
    cone.covariance_xx_m2 = cone.covariance_yy_m2 = 0.01;
    cone.probability[cone_observation_t::ORANGE_LARGE] = 0.95F;
    cone.existence = 0.99F;
    return cone;
  }

  heartbeat_t HeartbeatOf(const std::string& daemon) const {
    heartbeat_t heartbeat{};
    heartbeat.utime = utime;
    heartbeat.daemon = daemon;
    heartbeat.build = BuildId();
    heartbeat.types_hash = TypesHash();
    heartbeat.car_hash = config.SiblingHash("car");
    return heartbeat;
  }

  double Curvature() const {
    if (straight) return 0.0;
    const double s = std::fmod(distance, 50.0);
    return s > 34.0 ? kPi / 2.0 / 16.0 : 0.0;
  }

  void Run(double seconds) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds * 100.0)); ++i) Tick();
  }

  void StartDriving() {
    Run(10.0);
    vehicle.res_go = 1;
    Run(0.1);
    vehicle.res_go = 0;
    ASSERT_EQ(state->state, as_state_t::STATE_DRIVING) << state->reason;
    vehicle.brakes_engaged = 0;
  }

  Transport transport{"memq://"};
  Bus others{transport, "others", 1};
  Bus bus{transport, "mission_manager", 2};
  Config config = Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "mission_manager");
  HostFacts host{50.0, 4000.0};
  int looks = 0;  // at the computer
  MissionManagerNode node{LoadMissionManagerParams(config), bus, [this] {
                            ++looks;
                            return host;
                          }};
  vehicle_t vehicle{};
  pipeline_status_t status{};
  std::optional<as_state_t> state;
  int states = 0;
  int64_t utime = 1'700'000'000'000'000;
  int tick = 0;
  double speed = 0.0;
  double distance = 0.0;
  Pose2 truth;
  std::set<std::string> silent;    // channels
  std::vector<double> gates{6.0};  // that are seen, ahead of the start [m]
  bool straight = false;           // the course, instead of a lap
  double yaw_rate_error = 0.0;     // of VELOCITY while driving [rad/s]
  int32_t phase = global_map_t::PHASE_MAPPING;
};

TEST_F(MissionManagerNodeTest, AnswersEachVehicle) {
  Run(2.0);
  EXPECT_EQ(states, 40);
}

TEST_F(MissionManagerNodeTest, IsReadyAfterThreeSecondsOfAllChannelsAndSaysWhyNotBefore) {
  Run(2.9);
  EXPECT_EQ(state->state, as_state_t::STATE_OFF);
  EXPECT_EQ(state->reason, "IMU has just begun");
  Run(0.3);
  EXPECT_EQ(state->state, as_state_t::STATE_READY) << state->reason;
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
