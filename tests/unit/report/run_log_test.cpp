#include "tools/report/run_log.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/synthetic_run.hpp"

namespace hairpin {
namespace {

class RunLogFile : public testing::Test {
 protected:
  RunLogFile()
      : path_(testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name() +
              ".lcmlog") {}
  ~RunLogFile() override { std::filesystem::remove(path_); }

  template <class M>
  static void Write(LogWriter& writer, const char* channel, const M& message) {
    const auto bytes = Encoded(message);
    writer.Write(message.utime, channel, bytes.data(), bytes.size());
  }

  std::string path_;
};

TEST_F(RunLogFile, HoldsEveryMessageOfARun) {
  SyntheticRunParams params;
  params.distance = 20.0;
  const RunLog run = MakeSyntheticRun(params);
  WriteRunLog(run, path_);
  const RunLog loaded = LoadRunLog(path_);
  ASSERT_EQ(loaded.truth.size(), run.truth.size());
  EXPECT_EQ(loaded.truth.back().x_m, run.truth.back().x_m);
  ASSERT_TRUE(loaded.truth_track);
  EXPECT_EQ(loaded.truth_track->cones.size(), run.truth_track->cones.size());
  ASSERT_EQ(loaded.local_maps.size(), run.local_maps.size());
  EXPECT_EQ(loaded.local_maps.back().cones.size(), run.local_maps.back().cones.size());
  EXPECT_EQ(loaded.tracks.size(), run.tracks.size());
  EXPECT_EQ(loaded.pipeline_status.size(), run.pipeline_status.size());
  EXPECT_EQ(loaded.as_states.size(), run.as_states.size());
  EXPECT_EQ(loaded.drive_commands.size(), run.drive_commands.size());
  EXPECT_EQ(loaded.velocities.size(), run.velocities.size());
  EXPECT_EQ(loaded.cones_fusion.size(), run.cones_fusion.size());
  EXPECT_EQ(loaded.undecodable, 0);
  EXPECT_EQ(loaded.over_limit, 0);
}

TEST_F(RunLogFile, CountsBadMessagesAndGoesOn) {
  LogWriter writer(path_);
  truth_t truth{};
  Write(writer, "TRUTH", truth);
  Write(writer, "LOCAL_MAP", truth);  // another type
  truth.x_m = std::numeric_limits<double>::quiet_NaN();
  Write(writer, "TRUTH", truth);
  local_map_t hostile{};
  auto bytes = Encoded(hostile);
  bytes[bytes.size() - 4] = 0x40;  // a billion cones
  writer.Write(0, "LOCAL_MAP", bytes.data(), bytes.size());
  writer.Write(0, "VELOCITY", bytes.data(), 5);
  writer.Write(0, "SOMETHING_ELSE", bytes.data(), 5);
  truth.x_m = 1.0;
  truth.utime = truth.sequence = 1;
  Write(writer, "TRUTH", truth);
  writer.Close();
  const RunLog log = LoadRunLog(path_);
  EXPECT_EQ(log.events, 7);
  EXPECT_EQ(log.undecodable, 4);
  EXPECT_EQ(log.truth.size(), 2u);
  EXPECT_TRUE(log.local_maps.empty());
}

TEST_F(RunLogFile, SortsByTimeAndTakesDuplicatesOnce) {
  LogWriter writer(path_);
  for (const int32_t i : {0, 2, 1, 2, 3}) {
    velocity_t velocity{};
    velocity.utime = 10 * i;
    velocity.sequence = i;
    Write(writer, "VELOCITY", velocity);
  }
  writer.Close();
  const RunLog log = LoadRunLog(path_);
  ASSERT_EQ(log.velocities.size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(log.velocities[static_cast<size_t>(i)].utime, 10 * i);
}

TEST_F(RunLogFile, KeepsNoMoreThanItsMemoryAllows) {
  LogWriter writer(path_);
  const auto size = static_cast<int64_t>(Encoded(velocity_t{}).size());
  for (int i = 0; i < 10; ++i) {
    velocity_t velocity{};
    velocity.utime = velocity.sequence = i;
    Write(writer, "VELOCITY", velocity);
  }
  writer.Close();
  const RunLog log = LoadRunLog(path_, 4 * size);
  EXPECT_EQ(log.velocities.size(), 4u);
  EXPECT_EQ(log.over_limit, 6);
}

}  // namespace
}  // namespace hairpin
