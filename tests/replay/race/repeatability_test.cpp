#include <gtest/gtest.h>

#include "tests/support/race_run.hpp"

namespace hairpin {
namespace {

TEST(Race, OnTheDefaultTrackIsFinishedClean) {
  const RaceRun run = RunInProcess(DefaultTrackFile(), 1);
  EXPECT_TRUE(run.outcome.result.finished) << run.outcome.result.reason;
  EXPECT_EQ(run.outcome.result.cones_hit, 0);
  EXPECT_EQ(run.outcome.result.off_course, 0);
}

TEST(Race, WithTheSameSeedMakesTheSameBytes) {
  const RaceRun first = RunInProcess(DefaultTrackFile(), 2);
  const RaceRun second = RunInProcess(DefaultTrackFile(), 2);
  ASSERT_GT(first.bytes.size(), 1'000'000u);
  EXPECT_TRUE(first.bytes == second.bytes);
}

TEST(Race, WithAnotherSeedMakesOtherBytes) {
  const RaceRun first = RunInProcess(DefaultTrackFile(), 3);
  const RaceRun second = RunInProcess(DefaultTrackFile(), 4);
  EXPECT_FALSE(first.bytes == second.bytes);
}

}  // namespace
}  // namespace hairpin
