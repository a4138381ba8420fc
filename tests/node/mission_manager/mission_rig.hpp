#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/daemon.hpp"
#include "daemons/mission_manager/mission_manager_node.hpp"

namespace hairpin {

/// The rest of the car, standing or driving a 200 m lap whose gate is 6 m ahead of the start.
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
    return s > 34.0 ? std::numbers::pi / 2.0 / 16.0 : 0.0;
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

}  // namespace hairpin
