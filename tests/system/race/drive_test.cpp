// tools/drive as a person starts it: every daemon a process, on udpm, in a network namespace of its
// own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/process.hpp"
#include "tests/support/race_run.hpp"

namespace hairpin {
namespace {

using ::testing::HasSubstr;

const std::string kDrive = std::string(HAIRPIN_SOURCE_DIR) + "/tools/drive";
constexpr int kPatienceMs = 300'000;

bool HasNamespaces() {
  return Process({"unshare", "-Urnpf", "--mount-proc", "true"}).Wait(10'000) == 0;
}

TEST(Drive, FinishesALapWithEveryDaemonAProcessOfItsOwn) {
  if (!HasNamespaces()) GTEST_SKIP() << "no namespaces here";
  const TemporaryFolder folder;
  Process drive({kDrive, "--speed", "0", "--out", folder.File("run")});
  const std::optional<int> code = drive.Wait(kPatienceMs);
  ASSERT_TRUE(code) << "still running";
  EXPECT_EQ(*code, 0) << drive.Output();
  std::ifstream file(folder.File("run/report.json"));
  const nlohmann::json report = nlohmann::json::parse(file);
  EXPECT_EQ(report["lap"]["finished"], true);
  EXPECT_EQ(report["lap"]["cones_hit"], 0);
  EXPECT_EQ(report["path"]["out_of_track_percent"].size(), 16u);
  for (const char* stage :
       {"velocity_estimator", "local_mapper", "boundary_estimator", "path_tracker"}) {
    EXPECT_TRUE(report["latency_ms"][stage]["p99"].is_number()) << stage;
  }
  EXPECT_TRUE(std::filesystem::exists(folder.File("run/report.html")));
  EXPECT_GT(std::filesystem::file_size(folder.File("run/log.lcmlog")), 1'000'000u);
}

TEST(Drive, LocalMapperThatDiesAsAProcessComesBackAndTheLapIsFinished) {
  if (!HasNamespaces()) GTEST_SKIP() << "no namespaces here";
  const TemporaryFolder folder;
  Process drive({kDrive, "--speed", "1", "--out", folder.File("run"), "--fault",
                 "local_mapper off at 8 s for 0.2 s"});
  const std::optional<int> code = drive.Wait(kPatienceMs);
  ASSERT_TRUE(code) << "still running";
  std::ifstream file(folder.File("run/report.json"));
  EXPECT_EQ(nlohmann::json::parse(file)["lap"]["finished"], true) << drive.Output();
}

TEST(Drive, EndsAllOnCtrlC) {
  if (!HasNamespaces()) GTEST_SKIP() << "no namespaces here";
  const TemporaryFolder folder;
  // `timeout` signals its process group, as a terminal does.
  Process drive({"timeout", "--signal=INT", "8", kDrive, "--out", folder.File("run")});
  const std::optional<int> code = drive.Wait(kPatienceMs);
  ASSERT_TRUE(code) << "still running";
  EXPECT_EQ(*code, 124);
  EXPECT_THAT(drive.Output(), HasSubstr("interrupted"));
}

TEST(Drive, RefusesWrongUsageAndBadInputByName) {
  const TemporaryFolder folder;
  const auto run = [&folder](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), kDrive);
    arguments.insert(arguments.end(), {"--in-process", "--out", folder.File("run")});
    Process drive(arguments);
    const std::optional<int> code = drive.Wait(kPatienceMs);
    return std::pair(code.value_or(-1), drive.Output());
  };
  EXPECT_EQ(run({"--no-such-option"}).first, 2);
  for (const char* mission : {"skidpad", "inspection"}) {
    const auto [code, words] = run({"--mission", mission});
    EXPECT_EQ(code, 2);
    EXPECT_THAT(words, HasSubstr(std::string("mission ") + mission + " cannot be driven yet"));
  }
  const auto [fault_code, fault_words] = run({"--fault", "fuson off at 1 s"});
  EXPECT_EQ(fault_code, 2);
  EXPECT_THAT(fault_words, HasSubstr("did you mean fusion?"));
  std::ofstream(folder.File("bad.yaml")) << "track: [1, 2]\n";
  const auto [track_code, track_words] = run({"--track", folder.File("bad.yaml")});
  EXPECT_EQ(track_code, 78);
  EXPECT_THAT(track_words, HasSubstr("bad.yaml:"));
  const auto [config_code, config_words] = run({"--set", "path_tracker.max_speed_mps=1000"});
  EXPECT_EQ(config_code, 78);
  EXPECT_THAT(config_words, HasSubstr("max_speed_mps: `1000` must be from 0.5 to 40"));
}

}  // namespace
}  // namespace hairpin
