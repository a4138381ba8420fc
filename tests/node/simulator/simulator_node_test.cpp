#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "daemons/gnss_driver/gnss_driver.hpp"
#include "tests/support/oval_track.hpp"
#include "tests/support/simulator_setup.hpp"
#include "tools/simulator/simulator.hpp"

namespace hairpin {
namespace {

constexpr int64_t kTick = 10'000;

struct Heard {
  std::string channel;
  std::vector<uint8_t> bytes;
  bool operator==(const Heard&) const = default;
};

// The simulator on one bus, and on another what a stack would answer: a mission that goes by the
// rules, and a driver who follows the oval by the truth.
class Rig {
 public:
  explicit Rig(uint64_t seed = 1) : Rig(seed, ShippedSimulatorParams()) {}
  Rig(uint64_t seed, const SimulatorParams& params)
      : simulator(params, ShippedCar(), OvalTrack(), seed, simulator_bus_) {
    raw_ = transport_.Subscribe(
        ".*", [this](const std::string& channel, const uint8_t* data, size_t size) {
          heard.push_back({channel, {data, data + size}});
        });
    bus.Subscribe(channels::kVehicle, [this](const vehicle_t& m) { OnVehicle(m); });
    bus.Subscribe(channels::kTruth, [this](const truth_t& m) { truth = m; });
    bus.Subscribe(channels::kImu, [this](const imu_t& m) { OnImu(m); });
    const auto on_cones = [this](const cones_t& m) { fusion.emplace_back(truth.utime, m); };
    bus.Subscribe(channels::kConesFusion, on_cones);
    bus.Subscribe(channels::kTruthTrack, [this](const truth_track_t& m) { tracks.push_back(m); });
  }

  void Run(double seconds) {
    for (int i = 0;
         i < static_cast<int>(std::lround(seconds / Simulator::kTick)) && !simulator.done(); ++i) {
      simulator.Step();
      transport_.Drain();
    }
  }

  size_t Count(const std::string& channel) const {
    return static_cast<size_t>(std::count_if(heard.begin(), heard.end(),
                                             [&](const Heard& h) { return h.channel == channel; }));
  }
  void Clear() { heard.clear(); }
  int64_t Refused(const std::string& channel) const {
    for (const channel_health_t& health : simulator_bus_.Health()) {
      if (health.channel == channel) return health.refused;
    }
    return -1;
  }

 private:
  Transport transport_{"memq://"};
  Bus simulator_bus_{transport_, "simulator", 1};

 public:
  Bus bus{transport_, "stack", 2};
  Simulator simulator;
  std::vector<Heard> heard;
  truth_t truth{};
  vehicle_t vehicle{};
  as_state_t state{};
  std::vector<std::pair<int64_t, cones_t>> fusion;
  std::vector<truth_track_t> tracks;
  bool drives = true;
  bool commands = true;
  double speed = 8.0;

 private:
  void OnVehicle(const vehicle_t& m) {
    vehicle = m;
    state.utime = m.utime;
    if (state.state == as_state_t::STATE_UNKNOWN && m.brakes_engaged)
      state.state = as_state_t::STATE_READY;
    if (state.state == as_state_t::STATE_READY && m.res_go && drives)
      state.state = as_state_t::STATE_DRIVING;
    state.mission_finished = truth.lap >= 1;
    const bool stands = state.mission_finished && !m.res_stop && m.speed_mps < 0.1;
    if (stands && state.state == as_state_t::STATE_DRIVING)
      state.state = as_state_t::STATE_FINISHED;
    if (m.ebs_state == vehicle_t::EBS_ACTIVATED && state.state != as_state_t::STATE_FINISHED)
      state.state = as_state_t::STATE_EMERGENCY;
    bus.Publish(channels::kAsState, state);
  }

  // Pure pursuit of the oval's middle line.
  void OnImu(const imu_t& m) {
    if (!commands) return;
    const Pose2 T_map_base{truth.x_m, truth.y_m, truth.yaw_rad};
    double nearest = 0.0;
    for (double s = 0.0; s < OvalLength(); s += 0.5) {
      const auto distance = [&](double at) {
        return (OvalPose(at).position() - T_map_base.position()).norm();
      };
      if (distance(s) < distance(nearest)) nearest = s;
    }
    const Eigen::Vector2d goal = T_map_base.Inverse() * OvalPose(nearest + 4.0).position();
    drive_command_t command{};
    command.utime = m.utime;
    command.steering_angle_rad = std::atan(2.0 * 1.53 * goal.y() / goal.squaredNorm());
    const double target = state.mission_finished ? 0.0 : speed;
    for (double& torque : command.wheel_torque_nm) torque = 60.0 * (target - truth.vx_mps);
    command.brake = state.mission_finished ? 0.3 : 0.0;
    bus.Publish(channels::kDriveCommand, command);
  }

  std::shared_ptr<Transport::RawSubscription> raw_;
};

TEST(Simulator, PublishesEveryChannelAtItsRate) {
  Rig rig;
  rig.drives = false;
  rig.Run(10.0);
  EXPECT_EQ(rig.simulator.utime(), Simulator::kFirstUtime + 999 * kTick);
  EXPECT_EQ(rig.Count("IMU"), 1000u);
  EXPECT_EQ(rig.Count("MOTORS"), 1000u);
  EXPECT_EQ(rig.Count("STEERING"), 1000u);
  EXPECT_EQ(rig.Count("GROUND_SPEED"), 1000u);
  EXPECT_EQ(rig.Count("GNSS"), 100u);
  EXPECT_EQ(rig.Count("VEHICLE"), 200u);
  EXPECT_EQ(rig.Count("TRUTH"), 1000u);
  EXPECT_EQ(rig.Count("TRUTH_TRACK"), 2u);
  for (const char* channel : {"CONES_FUSION", "CONES_LIDAR", "CONES_CAMERA"})
    EXPECT_EQ(rig.Count(channel), 99u);
}

TEST(Simulator, EndsEachTickWithTheImu) {
  Rig rig;
  rig.commands = false;
  rig.drives = false;
  rig.Run(0.01);
  ASSERT_FALSE(rig.heard.empty());
  const auto imu = std::find_if(rig.heard.begin(), rig.heard.end(),
                                [](const Heard& h) { return h.channel == "IMU"; });
  std::vector<std::string> order;
  for (auto it = rig.heard.begin(); it <= imu; ++it) order.push_back(it->channel);
  EXPECT_THAT(order, testing::ElementsAre("TRUTH_TRACK", "TRUTH", "VEHICLE", "MOTORS", "STEERING",
                                          "GROUND_SPEED", "GNSS", "IMU"));
}

TEST(Simulator, PublishesConesTheirDelayAfterTheScan) {
  Rig rig;
  rig.Run(2.0);
  ASSERT_FALSE(rig.fusion.empty());
  for (const auto& [published, cones] : rig.fusion) EXPECT_EQ(published - cones.utime, 100'000);
  EXPECT_GT(rig.fusion.front().second.num_cones, 3);
}

TEST(Simulator, PressesGoFiveSecondsAfterReady) {
  Rig rig;
  rig.drives = false;
  rig.Run(1.0);
  ASSERT_EQ(rig.state.state, as_state_t::STATE_READY);
  EXPECT_TRUE(rig.vehicle.brakes_engaged);
  EXPECT_EQ(rig.vehicle.mission, vehicle_t::MISSION_AUTOCROSS);
  EXPECT_FALSE(rig.vehicle.res_go);
  while (!rig.vehicle.res_go && rig.simulator.utime() < Simulator::kFirstUtime + 1000 * kTick)
    rig.Run(0.01);
  // Ready is seen once the brakes have built up, within the first 0.2 s.
  EXPECT_NEAR(static_cast<double>(rig.vehicle.utime - Simulator::kFirstUtime) * 1e-6, 5.1, 0.1);
}

TEST(Simulator, LetsACarDriveItsLapAndFinish) {
  Rig rig;
  rig.Run(60.0);
  const RaceResult& result = rig.simulator.result();
  EXPECT_TRUE(result.finished) << result.reason;
  EXPECT_EQ(result.cones_hit, 0);
  EXPECT_EQ(result.off_course, 0);
  ASSERT_EQ(result.lap_times_s.size(), 1u);
  EXPECT_NEAR(result.lap_times_s[0], OvalLength() / 8.0, 2.0);
  EXPECT_EQ(rig.truth.lap, 1);
  EXPECT_EQ(rig.state.state, as_state_t::STATE_FINISHED);
}

TEST(Simulator, BrakesForGoodWhenCommandsCease) {
  Rig rig;
  rig.Run(9.0);
  ASSERT_GT(rig.truth.vx_mps, 6.0);
  rig.commands = false;
  rig.Run(20.0);
  EXPECT_TRUE(rig.simulator.done());
  EXPECT_FALSE(rig.simulator.result().finished);
  EXPECT_NE(rig.simulator.result().reason.find("commands have ceased"), std::string::npos);
  EXPECT_LT(std::abs(rig.truth.vx_mps), 0.1);
  EXPECT_TRUE(rig.simulator.actuators().ebs_activated());
}

TEST(Simulator, StopsOnTheRemoteStop) {
  Rig rig;
  rig.Run(9.0);
  rig.simulator.RequestResStop();
  rig.Run(10.0);
  EXPECT_TRUE(rig.vehicle.res_stop);
  EXPECT_NE(rig.simulator.result().reason.find("RES"), std::string::npos);
}

TEST(Simulator, SaysTheSameForTheSameSeed) {
  Rig one(5);
  Rig same(5);
  Rig other(6);
  for (Rig* rig : {&one, &same, &other}) rig->Run(8.0);
  EXPECT_TRUE(one.heard == same.heard);
  EXPECT_FALSE(one.heard == other.heard);
}

TEST(Simulator, ReallySilencesASource) {
  const std::map<std::string, std::string> channel_of{
      {"fusion", "CONES_FUSION"}, {"lidar", "CONES_LIDAR"},
      {"camera", "CONES_CAMERA"}, {"imu", "IMU"},
      {"wheels", "MOTORS"},       {"ground_speed", "GROUND_SPEED"},
      {"steering", "STEERING"},   {"gnss", "GNSS"}};
  EXPECT_EQ(channel_of.size(), Simulator::Sources().size());
  for (const auto& [source, channel] : channel_of) {
    Rig rig;
    rig.drives = false;
    rig.Run(0.5);
    EXPECT_GT(rig.Count(channel), 0u);
    rig.Clear();
    rig.simulator.SetSource(source, false);
    rig.Run(0.5);
    EXPECT_EQ(rig.Count(channel), 0u) << source;
    rig.simulator.SetSource(source, true);
    rig.Run(0.5);
    EXPECT_GT(rig.Count(channel), 0u) << source;
  }
}

TEST(Simulator, KeepsTheNoiseOfOthersWhenOneIsSilenced) {
  Rig with;
  Rig without;
  without.simulator.SetSource("lidar", false);
  without.simulator.SetSource("gnss", false);
  for (Rig* rig : {&with, &without}) {
    rig->drives = false;
    rig->Run(3.0);
    std::erase_if(rig->heard,
                  [](const Heard& h) { return h.channel == "CONES_LIDAR" || h.channel == "GNSS"; });
  }
  EXPECT_TRUE(with.heard == without.heard);
}

TEST(Simulator, RefusesASourceItDoesNotHaveAndNamesThoseItHas) {
  Rig rig;
  try {
    rig.simulator.SetSource("radar", false);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("radar"), testing::HasSubstr("ground_speed")));
  }
}

TEST(Simulator, PublishesTheTrackItDrives) {
  Rig rig;
  rig.drives = false;
  rig.Run(0.05);
  ASSERT_EQ(rig.tracks.size(), 1u);
  const Track oval = OvalTrack();
  EXPECT_EQ(rig.tracks[0].name, "oval");
  EXPECT_EQ(rig.tracks[0].seed, 1);
  EXPECT_EQ(rig.tracks[0].left.size(), oval.left.size());
  EXPECT_EQ(rig.tracks[0].cones.size(), oval.left.size() + oval.right.size() + oval.others.size());
  EXPECT_EQ(rig.tracks[0].cones[3].x_m, oval.left[3].position.x());
}

TEST(Simulator, RefusesACommandFromTheFuture) {
  Rig rig;
  rig.commands = false;
  rig.Run(0.05);
  drive_command_t command{};
  command.utime = rig.simulator.utime() + 5 * kTick;
  rig.bus.Publish(channels::kDriveCommand, command);
  rig.Run(0.01);
  EXPECT_EQ(rig.Refused("DRIVE_COMMAND"), 1);
}

TEST(Simulator, HasItsReceiverWhereTheTrackWasSurveyed) {
  Track track = OvalTrack();
  track.origin = GeodeticPoint{47.3961, 8.6481, 488.0};
  Transport transport("memq://");
  Bus bus(transport, "simulator", 1);
  Simulator simulator(ShippedSimulatorParams(), ShippedCar(), track, 1, bus);
  GnssDecoder decoder({});
  std::vector<GnssFix> fixes;
  simulator.OnGnss([&](std::span<const uint8_t> bytes) {
    for (const GnssFix& fix : decoder.Add(bytes)) fixes.push_back(fix);
  });
  for (int i = 0; i < 30; ++i) simulator.Step();
  ASSERT_FALSE(fixes.empty());
  const Eigen::Vector3d place = LocalEnu(*track.origin).ToEnu(fixes[0].position);
  EXPECT_NEAR(place.x(), track.start.x, 3.0);
  EXPECT_NEAR(place.y(), track.start.y, 3.0);
}

}  // namespace
}  // namespace hairpin
