#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "daemons/watchdog/watchdog.hpp"
#include "tests/unit/watchdog/traffic.hpp"

namespace hairpin {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

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

}  // namespace
}  // namespace hairpin
