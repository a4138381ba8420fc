#include "daemons/watchdog/watchdog.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "common/clock.hpp"
#include "tests/unit/watchdog/traffic.hpp"

namespace hairpin {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(Watchdog, ReportsEachTwentyMillisecondsOfDataTimeWithTheUtimeOfTheMessageThatCausedIt) {
  Traffic traffic;
  traffic.RunTo(3.0);
  const auto statuses = traffic.RunTo(4.0);
  ASSERT_EQ(statuses.size(), 50u);
  for (size_t i = 1; i < statuses.size(); ++i)
    EXPECT_EQ(statuses[i].utime - statuses[i - 1].utime, 20'000);
  EXPECT_EQ(statuses.front().utime % 20'000, 0);
}

TEST(Watchdog, ReportsOnceNotInABurstAfterAGapInDataTime) {
  Traffic traffic;
  traffic.RunTo(3.0);
  traffic.now += 2'000'000;
  traffic.statuses.clear();
  traffic.Tick();
  EXPECT_EQ(traffic.statuses.size(), 1u);
}

TEST(Watchdog, StartsInModeNoneAndIsInFusionASecondAfterThePipelinesWereHeard) {
  Traffic traffic;
  const auto before = traffic.RunTo(0.09);
  EXPECT_THAT(before, Each(AllOf(Field(&WatchdogStatus::mode, MapMode::kNone),
                                 Field(&WatchdogStatus::level, Level::kControlledStop),
                                 Field(&WatchdogStatus::reason, "no pipeline heard yet"),
                                 Field(&WatchdogStatus::culprits, IsEmpty()))));
  EXPECT_THAT(traffic.RunTo(1.09), Each(Field(&WatchdogStatus::mode, MapMode::kNone)));
  EXPECT_THAT(traffic.RunTo(1.12).back(), kHealthy);
  EXPECT_THAT(traffic.RunTo(10.0), Each(kHealthy));
}

TEST(Watchdog, SwitchesWithin270MillisecondsOfTheLastGoodMessageAndBackAfterASecondOfHealth) {
  for (int phase = 0; phase < 10; ++phase) {
    Traffic traffic;
    const double stop = 5.0 + 0.01 * phase;
    traffic.RunTo(stop);
    traffic.off = {"CONES_FUSION"};
    const int64_t last_good = Traffic::kStart + 5'000'000 - Traffic::kDelay;
    const auto degraded = [](const WatchdogStatus& status) {
      return status.mode == MapMode::kLidarAndCamera;
    };
    const WatchdogStatus down = First(traffic.RunTo(7.05), degraded);
    EXPECT_GT(down.utime - last_good, 250'000);
    EXPECT_LE(down.utime - last_good, 270'000);
    EXPECT_EQ(down.level, Level::kDegrade);
    EXPECT_EQ(down.speed_cap, 5.0);
    EXPECT_THAT(down.culprits, ElementsAre("CONES_FUSION"));
    EXPECT_THAT(down.reason, HasSubstr("CONES_FUSION is stale"));
    traffic.off.clear();
    const WatchdogStatus up = First(
        traffic.RunTo(9.0), [](const WatchdogStatus& s) { return s.mode == MapMode::kFusion; });
    EXPECT_EQ(up.utime - Traffic::kStart, 8'100'000) << "first heard again at 7.1 s";
    EXPECT_THAT(traffic.statuses.back(), kHealthy);
  }
}

TEST(Watchdog, SwitchesInTimeWhateverTheOffsetOfTheMessagesFromItsGrid) {
  for (int64_t offset = 0; offset < Traffic::kTick; offset += 1'700) {
    Traffic traffic(offset);
    traffic.RunTo(3.0);
    traffic.off = {"CONES_FUSION"};
    const int64_t last_good = traffic.now - Traffic::kDelay;
    const auto lost = First(traffic.RunTo(4.0),
                            [](const WatchdogStatus& s) { return s.mode != MapMode::kFusion; });
    EXPECT_GT(lost.utime - last_good, 250'000) << offset;
    EXPECT_LE(lost.utime - last_good, 270'000) << offset;
  }
}

TEST(Watchdog, StopsTheCarWhenEveryConeSourceDies) {
  Traffic traffic;
  traffic.RunTo(3.0);
  traffic.off = {"CONES_FUSION", "CONES_LIDAR", "CONES_CAMERA",
                 "LOCAL_MAP",    "TRACK",       "boundary_estimator"};
  const WatchdogStatus status = traffic.RunTo(5.0).back();
  EXPECT_EQ(status.mode, MapMode::kNone);
  EXPECT_EQ(status.level, Level::kControlledStop);
  EXPECT_THAT(status.culprits, ElementsAre("CONES_FUSION", "CONES_LIDAR", "CONES_CAMERA"))
      << "mapper and planner have nothing to answer, and are not to blame";
}

TEST(Watchdog, IsNotDisturbedByAnUnusedPipeline) {
  Traffic traffic;
  traffic.RunTo(3.0);
  traffic.off = {"CONES_LIDAR"};
  const WatchdogStatus status = traffic.RunTo(5.0).back();
  EXPECT_EQ(status.mode, MapMode::kFusion);
  EXPECT_EQ(status.level, Level::kLog);
  EXPECT_THAT(status.culprits, ElementsAre("CONES_LIDAR"));
}

TEST(Watchdog, IsNotFooledByOneMessageFromTheFuture) {
  Traffic traffic;
  traffic.RunTo(3.0);
  for (const int64_t ahead : {51'000, 300'000, 5'000'000, 9'999'000}) {
    traffic.SendAs("GNSS", {traffic.now + ahead, 1, traffic.sequences["GNSS"]++});
    EXPECT_TRUE(traffic.watchdog.put_aside());
    EXPECT_THAT(traffic.RunTo(SecondsBetween(Traffic::kStart, traffic.now) + 0.2), Each(kHealthy));
  }
}

TEST(Watchdog, FollowsAJumpOfDataTimeOnceASecondMessageAgrees) {
  Traffic traffic;
  traffic.RunTo(3.0);
  traffic.now += 5'000'000;
  traffic.Send("IMU", traffic.now);
  EXPECT_EQ(traffic.watchdog.now(), Traffic::kStart + 3'000'000);
  traffic.Send("MOTORS", traffic.now);
  EXPECT_EQ(traffic.watchdog.now(), Traffic::kStart + 8'000'000);
  EXPECT_EQ(traffic.statuses.back().mode, MapMode::kNone) << "no pipeline is that young";
  EXPECT_THAT(traffic.RunTo(9.2).back(), kHealthy);
}

TEST(Watchdog, DoesNotLetDataTimeGoBack) {
  Traffic traffic;
  traffic.RunTo(3.0);
  traffic.statuses.clear();
  traffic.now -= 2'000'000;
  traffic.RunTo(2.9);
  EXPECT_THAT(traffic.statuses, IsEmpty());
  EXPECT_EQ(traffic.watchdog.now(), Traffic::kStart + 3'000'000);
}

TEST(Watchdog, SaysTheSameTwice) {
  const auto run = [] {
    Traffic traffic;
    traffic.lost = [random = std::mt19937(3)](const std::string&) mutable {
      return random() % 10 == 0;
    };
    std::string text;
    for (const WatchdogStatus& status : traffic.RunTo(20.0)) {
      text += std::to_string(status.utime) + NameOf(status.mode) + status.reason + "\n";
    }
    return text;
  };
  EXPECT_EQ(run(), run());
}

TEST(Watchdog, NamesEverythingHeardWhenDataTimeStandsStill) {
  Traffic traffic;
  EXPECT_THAT(traffic.watchdog.Silent().culprits, IsEmpty());
  traffic.RunTo(3.0);
  const WatchdogStatus silent = traffic.watchdog.Silent();
  EXPECT_EQ(silent.utime, traffic.now);
  EXPECT_EQ(silent.mode, MapMode::kNone);
  EXPECT_EQ(silent.level, Level::kControlledStop);
  EXPECT_THAT(silent.culprits,
              AllOf(Contains("IMU"), Contains("CONES_FUSION"), Not(Contains("PIPELINE_STATUS"))));
}

TEST(Watchdog, RefusesParametersOutOfBoundsByName) {
  const auto refuses = [](const char* name, auto change) {
    WatchdogParams params = TestWatchdogParams();
    change(params);
    try {
      Watchdog(params, WatchedChannels(), WatchedDaemons());
      ADD_FAILURE() << name << " was taken";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(name));
    }
  };
  refuses("status_period_s", [](WatchdogParams& p) { p.status_period_s = 0.0; });
  refuses("max_time_step_s", [](WatchdogParams& p) { p.max_time_step_s = -1.0; });
  refuses("fusion_speed_cap", [](WatchdogParams& p) { p.fusion_speed_cap = 4.9; });
  refuses("degraded_speed_cap", [](WatchdogParams& p) { p.degraded_speed_cap = 0.0; });
  refuses("max_flaps", [](WatchdogParams& p) { p.max_flaps = -1; });
  refuses("flap_window_s", [](WatchdogParams& p) { p.flap_window_s = 0.0; });
  refuses("lost_after_s", [](WatchdogParams& p) { p.lost_after_s = 0.0; });
  refuses("silence_s", [](WatchdogParams& p) { p.silence_s = 0.0; });
  refuses("health_s", [](WatchdogParams& p) { p.source.health_s = 0.0; });
  refuses("max_late_in_a_row", [](WatchdogParams& p) { p.source.max_late_in_a_row = -1; });
  refuses("tolerated_loss", [](WatchdogParams& p) { p.source.tolerated_loss = 0.0; });
  refuses("degrading_loss", [](WatchdogParams& p) { p.source.degrading_loss = 0.01; });
  refuses("loss_evidence", [](WatchdogParams& p) { p.source.loss_evidence = 0.0; });
  refuses("second_publisher_returns",
          [](WatchdogParams& p) { p.source.second_publisher_returns = 0; });
  refuses("second_publisher_window_s",
          [](WatchdogParams& p) { p.source.second_publisher_window_s = 0.0; });
  refuses("restart_loop_restarts", [](WatchdogParams& p) { p.source.restart_loop_restarts = 0; });
  refuses("restart_loop_window_s", [](WatchdogParams& p) { p.source.restart_loop_window_s = 0.0; });
}

TEST(Watchdog, RefusesATableThatNamesAnUnknownChannel) {
  SourceSpec spec{"TRACK", 10.0, 0.25};
  spec.answers = {"LOKAL_MAP"};
  EXPECT_THROW(Watchdog(TestWatchdogParams(), {spec}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
