// The checks before AS Ready: each failure by name, in the order of the checks [FAULTS 27, 33, 34,
// 39].
#include "daemons/mission_manager/startup_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <stdexcept>

#include "daemons/mission_manager/host.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hairpin {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr int64_t kStart = 1'700'000'000'000'000;
const DaemonVersion kVersion{"b1", 7, 9};

StartupParams Params() {
  StartupParams params;
  params.channels = {{"IMU", 100.0, 0.05, true, true},
                     {"TRACK", 10.0, 0.25, true, false},
                     {"LIDAR_TOP", 10.0, 0.25, false, true}};
  params.rate = {3.0, 0.8};
  params.version = kVersion;
  params.log_folder = "/logs";
  params.min_free_disk = 1.0;
  params.min_buffer = 2000.0;
  return params;
}

class Startup : public testing::Test {
 protected:
  Startup() {
    checks.TakeHost({50.0, 4000.0});
    checks.HeardDaemon("local_mapper", kVersion);
  }
  void Run(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 100.0); ++i) {
      now += 10'000;
      if (imu) checks.HeardChannel("IMU", now, now);
      if (++tick % 10 == 0 && track) checks.HeardChannel("TRACK", now, now);
      if (tick % 10 == 0 && lidar) checks.HeardChannel("LIDAR_TOP", now, now);
    }
  }
  std::vector<std::string> Problems() const { return checks.Problems(now); }

  StartupChecks checks{Params()};
  int64_t now = kStart;
  int tick = 0;
  bool imu = true;
  bool track = true;
  bool lidar = false;
};

TEST_F(Startup, IsPassedAfterThreeSecondsOfEveryChannelAtItsRate) {
  Run(2.9);
  EXPECT_THAT(Problems(), ElementsAre("IMU has just begun", "TRACK has just begun"));
  Run(0.3);
  EXPECT_THAT(Problems(), IsEmpty());
}

TEST_F(Startup, NamesAChannelThatIsLateThenWaitsItsThreeSeconds) {
  track = false;
  Run(30.0);
  EXPECT_THAT(Problems(), ElementsAre("TRACK was never heard"));
  track = true;
  Run(2.9);
  EXPECT_THAT(Problems(), ElementsAre("TRACK has just begun"));
  Run(0.3);
  EXPECT_THAT(Problems(), IsEmpty());
}

TEST_F(Startup, DoesNotMissAChannelThatTheCarDoesNotHaveButHoldsOneThatWasHeardToItsRate) {
  Run(4.0);
  EXPECT_THAT(Problems(), IsEmpty());
  lidar = true;
  Run(4.0);
  EXPECT_THAT(Problems(), IsEmpty());
  lidar = false;
  Run(1.0);
  EXPECT_THAT(Problems(), ElementsAre("LIDAR_TOP is stale"));
}

TEST_F(Startup, NamesAChannelThatIsTooSlow) {
  for (int i = 0; i < 400; ++i) {
    now += 10'000;
    if (i % 2 == 0) checks.HeardChannel("IMU", now, now);  // 50 Hz
    if (i % 10 == 0) checks.HeardChannel("TRACK", now, now);
  }
  EXPECT_THAT(Problems(), ElementsAre("IMU is too slow"));
}

struct Failure {
  const char* name;
  std::function<void(StartupChecks&)> spoil;
  const char* problem;
};

class EachFailure : public Startup, public testing::WithParamInterface<Failure> {};

TEST_P(EachFailure, IsNamed) {
  Run(4.0);
  GetParam().spoil(checks);
  EXPECT_THAT(Problems(), ElementsAre(GetParam().problem));
}

INSTANTIATE_TEST_SUITE_P(
    Of, EachFailure,
    testing::Values(Failure{"build",
                            [](StartupChecks& checks) {
                              checks.HeardDaemon("watchdog", {"b2", 7, 9});
                            },
                            "watchdog is of another build"},
                    Failure{"types",
                            [](StartupChecks& checks) {
                              checks.HeardDaemon("watchdog", {"b1", 8, 9});
                            },
                            "watchdog has other message types"},
                    Failure{"disk",
                            [](StartupChecks& checks) {
                              checks.TakeHost({0.25, 4000.0});
                            },
                            "disk: 0.2 GB free for /logs, less than 1.0 GB"},
                    Failure{"folder",
                            [](StartupChecks& checks) {
                              checks.TakeHost({std::nullopt, 4000.0});
                            },
                            "disk: /logs cannot be looked at"},
                    Failure{"buffers",
                            [](StartupChecks& checks) {
                              checks.TakeHost({50.0, 212.992});
                            },
                            "buffers: the kernel gives a socket 213 kB, less than 2000 kB (sysctl "
                            "net.core.rmem_max)"},
                    Failure{"config",
                            [](StartupChecks& checks) {
                              checks.HeardDaemon("watchdog", {"b1", 7, 8});
                            },
                            "config: watchdog has another car.yaml"},
                    Failure{"no_config",
                            [](StartupChecks& checks) {
                              checks.HeardDaemon("watchdog", {"b1", 7, 0});
                            },
                            "config: watchdog found no car.yaml"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST_F(Startup, NamesAllInTheOrderOfTheChecks) {
  Run(4.0);
  track = false;
  Run(1.0);
  checks.HeardDaemon("a", {"b1", 7, 8});
  checks.HeardDaemon("b", {"b2", 7, 9});
  checks.TakeHost({0.0, 100.0});
  EXPECT_THAT(Problems(),
              ElementsAre("TRACK is stale", "b is of another build",
                          "disk: 0.0 GB free for /logs, less than 1.0 GB",
                          "buffers: the kernel gives a socket 100 kB, less than 2000 kB (sysctl "
                          "net.core.rmem_max)",
                          "config: a has another car.yaml"));
}

TEST_F(Startup, ForgivesADaemonThatWasStartedAnewWithTheRightBuild) {
  Run(4.0);
  checks.HeardDaemon("watchdog", {"b2", 7, 9});
  checks.HeardDaemon("watchdog", kVersion);
  EXPECT_THAT(Problems(), IsEmpty());
}

TEST_F(Startup, BearsAnyNumberOfDaemonsNames) {
  Run(4.0);
  for (int i = 0; i < 1000; ++i) checks.HeardDaemon(std::to_string(i), {"b2", 7, 9});
  EXPECT_LE(Problems().size(), 64u);
}

TEST(StartupChecks, WaitForTheFirstLookAtTheComputer) {
  StartupParams params = Params();
  params.channels.clear();
  EXPECT_THAT(StartupChecks(params).Problems(kStart), ElementsAre("disk: not looked at yet"));
  params.min_buffer = -1.0;
  EXPECT_THROW(StartupChecks{params}, std::invalid_argument);
}

TEST(Host, TellsWhatIsFreeWhereTheLogGoes) {
  const TemporaryFolder folder;
  const auto free = FreeDiskGb(folder.File("."));
  ASSERT_TRUE(free);
  EXPECT_GT(*free, 0.0);
  EXPECT_FALSE(FreeDiskGb(folder.File("no such folder")));
}

TEST(Host, TellsWhatTheKernelGivesOfTheBufferThatIsAskedFor) {
  EXPECT_FALSE(ReceiveBufferKb("memq://"));
  const auto small = ReceiveBufferKb("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=100000");
  ASSERT_TRUE(small);
  EXPECT_NEAR(*small, 100.0, 1.0);
  const auto huge = ReceiveBufferKb("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2000000000");
  ASSERT_TRUE(huge);
  EXPECT_LT(*huge, 1'900'000.0) << "no kernel gives that much";
  EXPECT_GE(*huge, *small);
}

}  // namespace
}  // namespace hairpin
