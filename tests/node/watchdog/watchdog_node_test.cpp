#include "daemons/watchdog/watchdog_node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/watchdog/traffic.hpp"

namespace hairpin {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int64_t kStart = 1'700'000'000'000'000;

template <class M>
M At(int64_t utime) {
  M message{};
  message.utime = utime;
  return message;
}

/// A watchdog and the rest of the car on one transport. 10 ms of data time pass with each Step, and
/// `clock_step_us` of wall time, in which the node is polled each 10 ms.
class WatchdogOnABus : public testing::Test {
 protected:
  WatchdogOnABus() {
    listener_.Subscribe(channels::kPipelineStatus,
                        [this](const pipeline_status_t& s) { statuses_.push_back(s); });
  }

  void Step(int64_t clock_step_us = 10'000) {
    now_ += 10'000;
    car_.Publish(channels::kImu, At<imu_t>(now_));
    car_.Publish(channels::kVelocity, At<velocity_t>(now_));
    if ((now_ - kStart) % 100'000 == 0) {
      if (fusion_lives_) car_.Publish(channels::kConesFusion, At<cones_t>(now_ - 100'000));
      car_.Publish(channels::kConesLidar, At<cones_t>(now_ - 100'000));
      car_.Publish(channels::kConesCamera, At<cones_t>(now_ - 100'000));
    }
    transport_.Drain();
    PassTime(clock_step_us);
  }
  void PassTime(int64_t micros) {
    const int64_t end = clock_.NowMicros() + micros;
    while (clock_.NowMicros() < end) {
      clock_.Set(std::min(end, clock_.NowMicros() + 10'000));
      node_.Poll();
      transport_.Drain();
    }
  }
  // Two seconds of health, then a second without fusion.
  std::vector<std::string> Replay(int64_t clock_step_us) {
    for (int i = 0; i < 300; ++i) {
      fusion_lives_ = i < 200;
      Step(clock_step_us);
    }
    std::vector<std::string> lines;
    for (const pipeline_status_t& s : statuses_) {
      lines.push_back(std::to_string(s.utime) + " " + std::to_string(s.map_mode) + " " + s.reason);
    }
    return lines;
  }

  Transport transport_{"memq://"};
  Bus watchdog_bus_{transport_, "watchdog", 1};
  Bus car_{transport_, "car", 2};
  Bus listener_{transport_, "listener", 3};
  ManualClock clock_;
  WatchdogNode node_{TestWatchdogParams(), watchdog_bus_, clock_};
  std::vector<pipeline_status_t> statuses_;
  int64_t now_ = kStart;
  bool fusion_lives_ = true;
};

TEST_F(WatchdogOnABus, TellsModeLevelCapFreshnessReasonAndCulprits) {
  for (int i = 0; i < 200; ++i) Step();
  EXPECT_EQ(statuses_.back().map_mode, pipeline_status_t::MODE_FUSION);
  EXPECT_EQ(statuses_.back().level, pipeline_status_t::LEVEL_LOG);
  EXPECT_EQ(statuses_.back().speed_cap_mps, 30.0);
  EXPECT_TRUE(statuses_.back().fusion_fresh);
  EXPECT_THAT(statuses_.back().culprits, IsEmpty());
  fusion_lives_ = false;
  for (int i = 0; i < 50; ++i) Step();
  EXPECT_EQ(statuses_.back().map_mode, pipeline_status_t::MODE_LIDAR_AND_CAMERA);
  EXPECT_EQ(statuses_.back().level, pipeline_status_t::LEVEL_DEGRADE);
  EXPECT_EQ(statuses_.back().speed_cap_mps, 5.0);
  EXPECT_FALSE(statuses_.back().fusion_fresh);
  EXPECT_TRUE(statuses_.back().lidar_fresh);
  EXPECT_TRUE(statuses_.back().camera_fresh);
  EXPECT_THAT(statuses_.back().culprits, ElementsAre("CONES_FUSION"));
}

class ReplayAt : public testing::TestWithParam<int64_t> {};

TEST_P(ReplayAt, AnySpeedDecidesTheSame) {
  struct Run : WatchdogOnABus {
    void TestBody() override {}
    using WatchdogOnABus::Replay;
  };
  const std::vector<std::string> in_real_time = Run().Replay(10'000);
  EXPECT_EQ(Run().Replay(GetParam()), in_real_time);
  EXPECT_THAT(in_real_time, Contains(HasSubstr("CONES_FUSION is stale")));
}

INSTANTIATE_TEST_SUITE_P(Watchdog, ReplayAt, testing::Values(0, 1'000, 100'000, 400'000));

TEST_F(WatchdogOnABus, StopsTheCarWhenNothingIsHeardForHalfASecondOfWallTime) {
  for (int i = 0; i < 200; ++i) Step();
  statuses_.clear();
  PassTime(480'000);  // 10 ms have passed in the last step
  EXPECT_THAT(statuses_, IsEmpty());
  PassTime(10'000);
  ASSERT_EQ(statuses_.size(), 1u);
  EXPECT_EQ(statuses_[0].utime, now_);
  EXPECT_EQ(statuses_[0].map_mode, pipeline_status_t::MODE_NONE);
  EXPECT_EQ(statuses_[0].level, pipeline_status_t::LEVEL_CONTROLLED_STOP);
  EXPECT_THAT(statuses_[0].culprits, Contains("IMU"));
  PassTime(200'000);
  EXPECT_EQ(statuses_.size(), 11u) << "repeated each 20 ms";
}

TEST_F(WatchdogOnABus, IsNotDeafenedByHeartbeatsIntoTakingSilenceForLife) {
  for (int i = 0; i < 200; ++i) Step();
  statuses_.clear();
  for (int i = 0; i < 10; ++i) {
    heartbeat_t heartbeat = At<heartbeat_t>(now_);
    heartbeat.daemon = "path_tracker";
    car_.Publish(channels::kHeartbeat, heartbeat);
    transport_.Drain();
    PassTime(60'000);
  }
  ASSERT_FALSE(statuses_.empty()) << "daemons live on, but no sensor does";
  EXPECT_EQ(statuses_.back().level, pipeline_status_t::LEVEL_CONTROLLED_STOP);
}

TEST_F(WatchdogOnABus, GoesOnAsBeforeWhenAPausedReplayGoesOn) {
  for (int i = 0; i < 200; ++i) Step();
  PassTime(2'000'000);
  Step();
  Step();
  EXPECT_EQ(statuses_.back().map_mode, pipeline_status_t::MODE_FUSION);
  EXPECT_FALSE(statuses_.back().latched);
}

TEST_F(WatchdogOnABus, StopsTheCarFromTheStartWhereNothingIsEverHeard) {
  PassTime(510'000);
  ASSERT_EQ(statuses_.size(), 1u);
  EXPECT_EQ(statuses_[0].utime, 0);
  EXPECT_EQ(statuses_[0].level, pipeline_status_t::LEVEL_CONTROLLED_STOP);
}

TEST_F(WatchdogOnABus, DoesNotHearTheSimulatorsTruth) {
  car_.Publish(channels::kTruth, At<truth_t>(kStart));
  car_.Publish(channels::kTruthTrack, At<truth_track_t>(kStart));
  transport_.Drain();
  EXPECT_EQ(watchdog_bus_.newest_utime(), 0);
}

TEST_F(WatchdogOnABus, NamesAnotherWatchdog) {
  Bus other(transport_, "watchdog", 4);
  for (int i = 0; i < 200; ++i) {
    Step();
    other.Publish(channels::kPipelineStatus, At<pipeline_status_t>(now_));
  }
  EXPECT_EQ(statuses_.back().boot_id, 1);
  EXPECT_EQ(statuses_.back().level, pipeline_status_t::LEVEL_CONTROLLED_STOP);
  EXPECT_THAT(statuses_.back().culprits, ElementsAre("PIPELINE_STATUS"));
}

TEST_F(WatchdogOnABus, CountsWhatItRefuses) {
  for (int i = 0; i < 10; ++i) Step();
  heartbeat_t nameless = At<heartbeat_t>(now_);
  car_.Publish(channels::kHeartbeat, nameless);
  nameless.daemon = std::string(65, 'x');
  car_.Publish(channels::kHeartbeat, nameless);
  car_.Publish(channels::kGnss, At<gnss_t>(now_ + 3'000'000));
  transport_.Drain();
  int64_t heartbeats = 0;
  int64_t gnss = 0;
  for (const channel_health_t& health : watchdog_bus_.Health()) {
    if (health.channel == "HEARTBEAT") heartbeats = health.refused;
    if (health.channel == "GNSS") gnss = health.refused;
  }
  EXPECT_EQ(heartbeats, 2);
  EXPECT_EQ(gnss, 1);
}

TEST(WatchdogConfig, OfTheCarIsTakenAndMakesANode) {
  const WatchdogParams params =
      LoadWatchdogParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "watchdog"));
  Transport transport("memq://");
  Bus bus(transport, "watchdog", 1);
  const ManualClock clock;
  EXPECT_NO_THROW(WatchdogNode(params, bus, clock));
  EXPECT_EQ(params.degraded_speed_cap, 5.0);
}

TEST(WatchdogConfig, RefusesACapInFusionBelowTheDegradedOne) {
  const Config config =
      Config::Load(HAIRPIN_SOURCE_DIR "/config", "watchdog", {"fusion_speed_cap_mps=3"});
  EXPECT_THROW(LoadWatchdogParams(config), ConfigError);
}

}  // namespace
}  // namespace hairpin
