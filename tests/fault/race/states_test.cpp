// FAULTS rows 18, 24, 34, 38 and 39: what the states of the autonomous system make of them, in the
// whole stack.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/clock.hpp"
#include "tests/support/stack_rig.hpp"

namespace hairpin {
namespace {

using testing::HasSubstr;

constexpr int32_t kReady = as_state_t::STATE_READY;
constexpr int32_t kDriving = as_state_t::STATE_DRIVING;

class States : public testing::Test {
 protected:
  void Drive(double seconds) {
    ASSERT_LT(rig.RunUntil([this] { return rig.Is(kDriving); }, 15.0), 15.0) << rig.as_state.reason;
    rig.Run(seconds);
    ASSERT_GT(rig.speed(), 4.0);
  }
  // A replay that somebody forgot, of a car that drives at 3 m/s.
  void ReplayVelocity() {
    velocity_t velocity{};
    velocity.utime = rig.simulator().utime();
    velocity.valid = 1;
    velocity.vx_mps = 3.0;
    for (const int i : {0, 4, 8}) velocity.covariance[i] = 0.01;
    rig.Publish(channels::kVelocity, velocity);
  }

  StackRig rig;
};

TEST_F(States, Row18ASecondPublisherKeepsTheCarFromReadyAndIsNamed) {
  rig.meddle = [this] { ReplayVelocity(); };
  rig.Run(10.0);
  EXPECT_TRUE(rig.Is(as_state_t::STATE_OFF));
  EXPECT_THAT(rig.as_state.reason, HasSubstr("VELOCITY has a second publisher"));
  rig.meddle = nullptr;
  rig.Run(10.0);
  EXPECT_TRUE(rig.Is(kReady)) << rig.as_state.reason;
}

TEST_F(States, Row18ASecondPublisherStopsTheCarWithin100Milliseconds) {
  Drive(6.0);
  rig.meddle = [this] { ReplayVelocity(); };
  const double seconds = rig.RunUntil(
      [this] { return rig.status.level >= pipeline_status_t::LEVEL_CONTROLLED_STOP; }, 1.0);
  EXPECT_LE(seconds, 0.1);
  EXPECT_THAT(rig.status.reason, HasSubstr("VELOCITY has a second publisher"));
  EXPECT_LT(rig.RunUntil([this] { return rig.speed() < 0.1; }, 5.0), 5.0);
  EXPECT_EQ(rig.simulator().result().off_course, 0);
}

TEST_F(States, Row34ADaemonOfAnotherBuildKeepsTheCarFromReadyAndIsNamed) {
  rig.meddle = [this] {
    heartbeat_t heartbeat{};
    heartbeat.utime = rig.simulator().utime();
    heartbeat.daemon = "pit_bridge";
    heartbeat.build = "of last year";
    heartbeat.types_hash = TypesHash();
    rig.Publish(channels::kHeartbeat, heartbeat);
  };
  rig.Run(10.0);
  EXPECT_TRUE(rig.Is(as_state_t::STATE_OFF));
  EXPECT_EQ(rig.as_state.reason, "pit_bridge is of another build");
}

TEST_F(States, Row38TheResIsReportedWithin200MillisecondsAndForGood) {
  Drive(6.0);
  rig.simulator().RequestResStop();
  EXPECT_LE(rig.RunUntil([this] { return rig.Is(as_state_t::STATE_EMERGENCY); }, 1.0), 0.2);
  EXPECT_LT(rig.RunUntil([this] { return std::abs(rig.speed()) < 0.1; }, 3.0), 3.0);
  rig.Run(5.0);
  EXPECT_TRUE(rig.Is(as_state_t::STATE_EMERGENCY));
}

TEST_F(States, Row39DaemonsMayStartInAnyOrderReadyComesThreeSecondsAfterTheLast) {
  std::vector<std::string> daemons = StackDaemons(SensorLevel::kCones);
  for (const std::string& daemon : daemons) rig.stack().SetDaemon(daemon, false);
  for (auto daemon = daemons.rbegin(); daemon != daemons.rend(); ++daemon) {
    rig.Run(0.7);
    EXPECT_FALSE(rig.Is(kReady));
    rig.stack().SetDaemon(*daemon, true);
  }
  const double seconds = rig.RunUntil([this] { return rig.Is(kReady); }, 30.0);
  EXPECT_GE(seconds, 3.0);
  EXPECT_LE(seconds, 5.5) << rig.as_state.reason;
}

class Missing : public States,
                public testing::WithParamInterface<std::pair<const char*, const char*>> {};

TEST_P(Missing, KeepsTheCarFromReadyAndIsNamedBy30Seconds) {
  rig.stack().SetDaemon(GetParam().first, false);
  rig.Run(30.0);
  EXPECT_TRUE(rig.Is(as_state_t::STATE_OFF));
  EXPECT_EQ(rig.as_state.reason, GetParam().second);
  rig.stack().SetDaemon(GetParam().first, true);
  EXPECT_LE(rig.RunUntil([this] { return rig.Is(kReady); }, 10.0), 6.5) << rig.as_state.reason;
}

INSTANTIATE_TEST_SUITE_P(Daemons, Missing,
                         testing::Values(std::pair("velocity_estimator",
                                                   "VELOCITY was never heard"),
                                         std::pair("local_mapper", "LOCAL_MAP was never heard"),
                                         std::pair("global_mapper", "GLOBAL_MAP was never heard"),
                                         std::pair("boundary_estimator", "TRACK was never heard"),
                                         std::pair("path_tracker", "DRIVE_COMMAND was never heard"),
                                         std::pair("watchdog", "PIPELINE_STATUS was never heard")),
                         [](const auto& instance) { return std::string(instance.param.first); });

TEST_F(States, ASensorThatIsDeadBeforeTheStartKeepsTheCarFromReadyAndIsNamed) {
  rig.Run(1.0);
  rig.simulator().SetSource("camera", false);
  rig.simulator().SetSource("gnss", false);
  rig.Run(10.0);
  EXPECT_EQ(rig.as_state.reason, "GNSS is stale");
  rig.simulator().SetSource("gnss", true);
  rig.Run(4.0);
  EXPECT_EQ(rig.as_state.reason, "CONES_CAMERA is stale");
  rig.simulator().SetSource("camera", true);
  rig.Run(4.0);
  EXPECT_TRUE(rig.Is(kReady)) << rig.as_state.reason;
}

class Rearming : public testing::TestWithParam<bool> {};

TEST_P(Rearming, NeverFollowsTheDeathOfMissionManagerByItself) {
  const RaceRun run = RunInProcess(DefaultTrackFile(), 1, {"mission_manager off at 8 s for 0.1 s"},
                                   {}, SensorLevel::kCones, GetParam());
  EXPECT_FALSE(run.outcome.result.finished);
  EXPECT_EQ(run.outcome.result.off_course, 0);
  const int64_t off = AddSeconds(GoTime(run.log), 8.0);
  bool came_back = false;
  for (const as_state_t& state : run.log.as_states) {
    if (state.utime <= off) continue;
    came_back = true;
    ASSERT_NE(state.state, kDriving) << SecondsBetween(off, state.utime);
  }
  EXPECT_TRUE(came_back);
  for (const truth_t& truth : run.log.truth) {
    if (truth.utime <= AddSeconds(off, 4.0)) continue;
    ASSERT_LE(std::hypot(truth.vx_mps, truth.vy_mps), 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(Row24, Rearming, testing::Bool(), [](const auto& instance) {
  return std::string(instance.param ? "ByCan" : "ByMessages");
});

class RefusedMission
    : public testing::TestWithParam<std::tuple<const char*, int32_t, const char*>> {};

TEST_P(RefusedMission, NeverStartsAndIsNamed) {
  StackRig rig({"simulator.race_control.mission=" + std::to_string(std::get<1>(GetParam()))});
  rig.Run(10.0);
  EXPECT_TRUE(rig.Is(as_state_t::STATE_OFF));
  EXPECT_EQ(rig.as_state.reason, std::get<2>(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(
    Names, RefusedMission,
    testing::Values(std::tuple("skidpad", int32_t{vehicle_t::MISSION_SKIDPAD},
                               "mission skidpad cannot be driven yet"),
                    std::tuple("inspection", int32_t{vehicle_t::MISSION_INSPECTION},
                               "mission inspection cannot be driven yet")),
    [](const auto& instance) { return std::string(std::get<0>(instance.param)); });

}  // namespace
}  // namespace hairpin
