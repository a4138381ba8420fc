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

const auto kHealthy =
    AllOf(Field(&WatchdogStatus::mode, MapMode::kFusion),
          Field(&WatchdogStatus::level, Level::kLog), Field(&WatchdogStatus::speed_cap, 30.0),
          Field(&WatchdogStatus::culprits, IsEmpty()), Field(&WatchdogStatus::reason, "healthy"));

// The first status of `statuses` for which `holds`; its utime is 0 where there is none.
template <class Predicate>
WatchdogStatus First(const std::vector<WatchdogStatus>& statuses, Predicate holds) {
  const auto found = std::find_if(statuses.begin(), statuses.end(), holds);
  return found == statuses.end() ? WatchdogStatus{} : *found;
}

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

struct Death {
  const char* channel;
  Level soon;      // within 0.4 s
  Level for_good;  // after 3 s
};

class DeathOf : public testing::TestWithParam<Death> {};

TEST_P(DeathOf, HasItsLevelAndIsNamed) {
  const auto& [channel, soon, for_good] = GetParam();
  Traffic traffic;
  traffic.RunTo(3.0);
  traffic.off = {channel};
  EXPECT_EQ(traffic.RunTo(3.4).back().level, soon);
  EXPECT_THAT(traffic.RunTo(6.0).back().culprits, ElementsAre(channel));
  EXPECT_EQ(traffic.statuses.back().level, for_good);
  traffic.off.clear();
  EXPECT_THAT(traffic.RunTo(6.2).back(), kHealthy);
}

INSTANTIATE_TEST_SUITE_P(
    Watchdog, DeathOf,
    testing::Values(Death{"VELOCITY", Level::kControlledStop, Level::kControlledStop},
                    Death{"VEHICLE", Level::kControlledStop, Level::kControlledStop},
                    Death{"DRIVE_COMMAND", Level::kControlledStop, Level::kControlledStop},
                    Death{"AS_STATE", Level::kEmergency, Level::kEmergency},
                    Death{"LOCAL_MAP", Level::kDegrade, Level::kControlledStop},
                    Death{"TRACK", Level::kDegrade, Level::kControlledStop},
                    Death{"GNSS", Level::kLog, Level::kLog},
                    Death{"IMU", Level::kLog, Level::kLog}),
    [](const auto& tested) { return tested.param.channel; });

TEST(Watchdog, StopsWithinTheDeadlineOfAVelocity) {
  Traffic traffic;
  traffic.RunTo(3.0);
  traffic.off = {"VELOCITY"};
  const auto stopped = First(traffic.RunTo(4.0), [](const WatchdogStatus& s) {
    return s.level == Level::kControlledStop;
  });
  EXPECT_EQ(stopped.utime - Traffic::kStart, 3'110'000) << "at once, not on the next 20 ms";
  EXPECT_THAT(stopped.culprits, ElementsAre("VELOCITY"));
}

TEST(Watchdog, DoesNotBlameTheMapperForTheSilenceBeforeTheModeRoseAgain) {
  Traffic traffic;
  traffic.RunTo(3.0);
  const std::set<std::string> downstream{"LOCAL_MAP", "TRACK", "boundary_estimator"};
  traffic.off = downstream;
  traffic.off.insert({"CONES_FUSION", "CONES_LIDAR", "CONES_CAMERA"});
  traffic.RunTo(6.0);
  traffic.off = downstream;
  traffic.RunTo(7.11);
  ASSERT_EQ(traffic.statuses.back().mode, MapMode::kFusion);
  traffic.off.clear();
  EXPECT_THAT(traffic.RunTo(9.0), Each(kHealthy));
}

TEST(Watchdog, NamesADaemonThatFellSilent) {
  for (const char* daemon : {"velocity_estimator", "boundary_estimator"}) {
    Traffic traffic;
    traffic.RunTo(3.0);
    traffic.off = {daemon};
    EXPECT_THAT(traffic.RunTo(3.45).back(), kHealthy);
    const WatchdogStatus status = traffic.RunTo(3.8).back();
    EXPECT_THAT(status.culprits, ElementsAre(daemon));
    EXPECT_EQ(status.level, Level::kDegrade);
    traffic.off.clear();
    EXPECT_THAT(traffic.RunTo(4.0).back(), kHealthy);
  }
}

TEST(Watchdog, OnlyNamesADaemonWithoutWhichTheCarDrivesOn) {
  Traffic traffic;
  traffic.RunTo(3.0);
  traffic.Heartbeat("pit_bridge");
  const WatchdogStatus status = traffic.RunTo(4.0).back();
  EXPECT_THAT(status.culprits, ElementsAre("pit_bridge"));
  EXPECT_EQ(status.level, Level::kLog);
}

TEST(Watchdog, RefusesMoreDaemonsThanThereCanBe) {
  Traffic traffic;
  traffic.RunTo(1.0);
  int taken = 0;
  for (int i = 0; i < 1000; ++i)
    taken += traffic.watchdog.HearHeartbeat("daemon" + std::to_string(i), {0, i, 0}) ? 1 : 0;
  EXPECT_LE(taken, 64);
}

TEST(Watchdog, StopsTheCarForARestartLoop) {
  Traffic traffic;
  traffic.RunTo(3.0);
  traffic.off = {"TRACK"};
  for (int64_t restart = 2; restart <= 6; ++restart) {
    traffic.off.clear();
    traffic.boots["TRACK"] = restart;
    traffic.sequences["TRACK"] = 0;
    traffic.RunTo(3.0 + 1.0 * static_cast<double>(restart));
    EXPECT_EQ(traffic.statuses.back().level, restart < 6 ? Level::kLog : Level::kControlledStop)
        << restart;
  }
  EXPECT_THAT(traffic.statuses.back().reason, HasSubstr("TRACK restarts again and again"));
}

TEST(Watchdog, TakesARestartedSenderForHealthy) {
  Traffic traffic;
  traffic.RunTo(3.0);
  traffic.boots["CONES_FUSION"] = 2;
  traffic.sequences["CONES_FUSION"] = 0;
  EXPECT_THAT(traffic.RunTo(6.0), Each(kHealthy));
}

TEST(Watchdog, NamesASecondPublisherAndStopsTheCarWhileItPersists) {
  Traffic traffic;
  traffic.RunTo(3.0);
  int64_t sequence = 0;
  const auto stopped = [](const WatchdogStatus& status) {
    return status.level == Level::kControlledStop;
  };
  for (double t = 3.01; t < 3.5; t += 0.01) {
    traffic.RunTo(t);
    traffic.SendAs("DRIVE_COMMAND", {traffic.now, 666, sequence++});
  }
  const WatchdogStatus stop = First(traffic.statuses, [&](const WatchdogStatus& s) {
    return s.utime > Traffic::kStart + 3'000'000 && stopped(s);
  });
  EXPECT_LE(stop.utime - Traffic::kStart, 3'100'000);
  EXPECT_THAT(stop.culprits, ElementsAre("DRIVE_COMMAND"));
  EXPECT_THAT(stop.reason, HasSubstr("second publisher"));
  EXPECT_THAT(traffic.RunTo(9.0).back(), kHealthy) << "it has left";
}

TEST(Watchdog, DegradesAtTwentyPercentLossOnAChannelAndNotAtFive) {
  for (const double loss : {0.01, 0.05, 0.2}) {
    Traffic traffic;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    traffic.lost = [&](const std::string& channel) {
      return channel == "VELOCITY" && uniform(random) < loss;
    };
    traffic.RunTo(3.0);
    const auto statuses = traffic.RunTo(30.0);
    const auto alarm =
        First(statuses, [](const WatchdogStatus& s) { return s.level == Level::kDegrade; });
    if (loss < 0.2) {
      EXPECT_EQ(alarm.utime, 0) << loss;
    } else {
      EXPECT_THAT(alarm.reason, HasSubstr("VELOCITY loses messages"));
      EXPECT_THAT(alarm.culprits, ElementsAre("VELOCITY"));
    }
  }
}

TEST(Watchdog, ComesThroughFivePercentLossOnEveryChannelWithoutALatchedMode) {
  for (uint32_t seed = 1; seed <= 5; ++seed) {
    Traffic traffic;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    traffic.lost = [&](const std::string&) { return uniform(random) < 0.05; };
    traffic.RunTo(3.0);
    const auto statuses = traffic.RunTo(63.0);
    EXPECT_THAT(statuses, Each(Field(&WatchdogStatus::latched, false)));
    const auto degraded =
        std::count_if(statuses.begin(), statuses.end(),
                      [](const WatchdogStatus& s) { return s.mode != MapMode::kFusion; });
    EXPECT_LT(static_cast<double>(degraded), 0.05 * static_cast<double>(statuses.size()))
        << "a lost set of cones costs 50 ms, not a second";
  }
}

TEST(Watchdog, CountsDeadlineMissesOfAStarvedComputer) {
  Traffic traffic;
  traffic.RunTo(3.0);
  traffic.off = {"TRACK"};
  int64_t sequence = 1'000'000;
  for (int i = 1; i <= 5; ++i) {
    traffic.RunTo(3.0 + 0.1 * i);
    traffic.SendAs("TRACK", {traffic.now - 251'000, 1, ++sequence});
    traffic.RunTo(3.02 + 0.1 * i);
    EXPECT_EQ(traffic.statuses.back().level, i <= 3 ? Level::kLog : Level::kDegrade) << i;
  }
  EXPECT_THAT(traffic.statuses.back().reason, HasSubstr("TRACK is late"));
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
