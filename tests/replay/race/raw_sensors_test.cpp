#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "common/map_mode.hpp"
#include "tests/support/race_run.hpp"
#include "tools/report/log_reader.hpp"

namespace hairpin {
namespace {

// A lap that the referee ends after so many seconds.
RaceRun RunRaw(int seconds) {
  return RunInProcess(DefaultTrackFile(), 1, {},
                      {"simulator.referee.time_limit_per_lap_s=" + std::to_string(seconds)},
                      SensorLevel::kRaw);
}

// Boot id of the sender, the second field of every message, behind the fingerprint; big-endian.
int64_t SenderOf(const LogEvent& event) {
  uint64_t id = 0;
  for (size_t i = 16; i < 24; ++i) id = id << 8 | event.data.at(i);
  return static_cast<int64_t>(id);
}

TEST(RawSensors, DriveTheCarByLidarAloneAtFiveMetresPerSecond) {
  const RaceRun run = RunRaw(5);
  EXPECT_EQ(run.outcome.result.cones_hit, 0);
  EXPECT_EQ(run.outcome.result.off_course, 0);
  ASSERT_FALSE(run.log.truth.empty());
  EXPECT_GT(run.log.truth.back().distance_m, 15.0);
  EXPECT_LT(run.outcome.result.max_speed_mps, 5.5);
  ASSERT_FALSE(run.log.pipeline_status.empty());
  EXPECT_EQ(run.log.pipeline_status.back().map_mode, static_cast<int>(MapMode::kLidarOnly));
}

TEST(RawSensors, ReachTheBusThroughTheirDriversOnlyAndRepeatToTheByte) {
  const RaceRun run = RunRaw(1);
  const TemporaryFolder folder;
  std::ofstream(folder.File("log.lcmlog"), std::ios::binary) << run.bytes;
  LogReader reader(folder.File("log.lcmlog"));
  std::map<std::string, std::set<int64_t>> senders;
  std::map<int64_t, std::string> daemons;
  while (const std::optional<LogEvent> event = reader.Next()) {
    senders[event->channel].insert(SenderOf(*event));
    heartbeat_t heartbeat;
    if (event->channel != channels::kHeartbeat.name) continue;
    ASSERT_GT(heartbeat.decode(event->data.data(), 0, static_cast<int>(event->data.size())), 0);
    daemons[heartbeat.boot_id] = heartbeat.daemon;
  }
  std::set<std::string> of_simulator;
  for (const auto& [channel, ids] : senders) {
    if (ids.contains(kSimulatorBootId)) of_simulator.insert(channel);
  }
  EXPECT_EQ(of_simulator,
            (std::set<std::string>{channels::kTruth.name, channels::kTruthTrack.name}));
  const auto sender_of = [&](const std::string& channel) {
    return senders[channel].size() == 1 ? daemons[*senders[channel].begin()] : "not one";
  };
  for (const char* channel : {channels::kImu.name, channels::kMotors.name, channels::kSteering.name,
                              channels::kGroundSpeed.name, channels::kVehicle.name})
    EXPECT_EQ(sender_of(channel), "can_gateway") << channel;
  EXPECT_EQ(sender_of(channels::kGnss.name), "gnss_driver");
  EXPECT_EQ(sender_of(channels::kConesLidar.name), "lidar_cone_detector");

  ASSERT_GT(run.bytes.size(), 500'000u);
  EXPECT_TRUE(run.bytes == RunRaw(1).bytes);
}

}  // namespace
}  // namespace hairpin
