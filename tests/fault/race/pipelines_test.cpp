// FAULTS rows 2 to 5: pipelines die in mid-lap; read from the log of the lap.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/clock.hpp"
#include "common/map_mode.hpp"
#include "tests/support/race_run.hpp"

namespace hairpin {
namespace {

constexpr double kSwitchBound = 0.27;    // s, from the last good message
constexpr double kHealthBeforeUp = 1.0;  // s
constexpr double kDegradedSpeed = 5.0;   // m/s

// Time of the first status from `from` on that has (or has no longer) `mode`.
int64_t FirstStatus(const RunLog& log, int64_t from, MapMode mode, bool equal) {
  for (const pipeline_status_t& status : log.pipeline_status) {
    if (status.utime >= from && (status.map_mode == static_cast<int>(mode)) == equal)
      return status.utime;
  }
  return 0;
}

double MaxSpeedAfter(const RunLog& log, int64_t utime) {
  double fastest = 0.0;
  for (const truth_t& truth : log.truth) {
    if (truth.utime >= utime) fastest = std::max(fastest, std::hypot(truth.vx_mps, truth.vy_mps));
  }
  return fastest;
}

struct DegradedMode {
  const char* name;
  std::vector<std::string> faults;
  MapMode mode;
};

class DegradedLap : public ::testing::TestWithParam<DegradedMode> {};

TEST_P(DegradedLap, SwitchesInTimeAndFinishesTheLap) {
  const RaceRun run = RunInProcess(DefaultTrackFile(), 1, GetParam().faults);
  const int64_t go = GoTime(run.log);
  const int64_t last_good = run.log.cones_fusion.back().utime;
  const int64_t switched = FirstStatus(run.log, go, MapMode::kFusion, false);
  ASSERT_GT(switched, last_good);
  EXPECT_LE(SecondsBetween(last_good, switched), kSwitchBound);
  EXPECT_GT(FirstStatus(run.log, switched, GetParam().mode, true), 0);
  EXPECT_LE(MaxSpeedAfter(run.log, AddSeconds(switched, 3.0)), kDegradedSpeed + 0.5);
  EXPECT_TRUE(run.outcome.result.finished) << run.outcome.result.reason;
  EXPECT_EQ(run.outcome.result.cones_hit, 0);
  EXPECT_EQ(run.outcome.result.off_course, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Pipelines, DegradedLap,
    ::testing::Values(
        DegradedMode{"LidarAndCamera", {"fusion off at 5 s"}, MapMode::kLidarAndCamera},
        DegradedMode{"LidarOnly", {"fusion off at 5 s", "camera off at 5 s"}, MapMode::kLidarOnly},
        DegradedMode{
            "CameraOnly", {"fusion off at 5 s", "lidar off at 5 s"}, MapMode::kCameraOnly}),
    [](const auto& instance) { return instance.param.name; });

TEST(Pipelines, ComeBackAfterASecondOfHealth) {
  const RaceRun run = RunInProcess(DefaultTrackFile(), 1, {"fusion off at 5 s for 4 s"});
  const int64_t off = AddSeconds(GoTime(run.log), 5.0);
  const int64_t switched = FirstStatus(run.log, off, MapMode::kFusion, false);
  ASSERT_GT(switched, 0);
  const int64_t back = FirstStatus(run.log, switched, MapMode::kFusion, true);
  ASSERT_GT(back, 0);
  const auto first_again =
      std::find_if(run.log.cones_fusion.begin(), run.log.cones_fusion.end(),
                   [off](const cones_t& message) { return message.utime > AddSeconds(off, 3.5); });
  ASSERT_NE(first_again, run.log.cones_fusion.end());
  const double health = SecondsBetween(first_again->utime, back);
  EXPECT_GE(health, kHealthBeforeUp);
  EXPECT_LE(health, kHealthBeforeUp + 0.3);  // 100 ms of sensor delay, a tick, and a period
}

TEST(Pipelines, AllDeadStopTheCarOnItsPath) {
  const RaceRun run = RunInProcess(DefaultTrackFile(), 1,
                                   {"fusion off at 8 s", "lidar off at 8 s", "camera off at 8 s"});
  const int64_t off = AddSeconds(GoTime(run.log), 8.0);
  int64_t last_good = 0;
  for (const auto* cones : {&run.log.cones_fusion, &run.log.cones_lidar, &run.log.cones_camera}) {
    if (!cones->empty()) last_good = std::max(last_good, cones->back().utime);
  }
  const int64_t none = FirstStatus(run.log, off, MapMode::kNone, true);
  ASSERT_GT(none, 0);
  EXPECT_LE(SecondsBetween(last_good, none), kSwitchBound);
  EXPECT_FALSE(run.outcome.result.finished);
  EXPECT_EQ(run.outcome.result.off_course, 0);
  EXPECT_EQ(run.outcome.result.cones_hit, 0);
  // 0.5 s of the last path and 12 m/s at 5 m/s2 and more of braking.
  EXPECT_LE(MaxSpeedAfter(run.log, AddSeconds(none, 4.0)), 0.1);
}

TEST(Pipelines, NeverUpdateTheMapTwiceFromOneScan) {
  const RaceRun run = RunInProcess(DefaultTrackFile(), 1, {"fusion off at 5 s for 3 s"});
  bool switched = false;
  for (size_t i = 1; i < run.log.local_maps.size(); ++i) {
    const local_map_t& before = run.log.local_maps[i - 1];
    const local_map_t& map = run.log.local_maps[i];
    EXPECT_NE(map.utime, before.utime);
    const int fusion = static_cast<int>(MapMode::kFusion);
    if ((map.map_mode == fusion) == (before.map_mode == fusion)) continue;
    switched = true;
    // LiDAR scans enter the fusion too, at 10 Hz.
    EXPECT_GE(SecondsBetween(before.utime, map.utime), 0.05);
  }
  EXPECT_TRUE(switched);
}

}  // namespace
}  // namespace hairpin
