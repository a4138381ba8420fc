#include "daemons/velocity_estimator/sensor_monitor.hpp"

#include <gtest/gtest.h>

namespace hairpin {
namespace {

constexpr SensorMonitorParams kParams{
    .reject_after = 1.0, .readmit_after = 2.0, .frozen_after = 0.2};
constexpr double kDeadline = 0.05;

int64_t Millis(int64_t ms) { return 1'000'000 + ms * 1000; }

/// Judges at 100 Hz in [from, to) ms; returns the last answer.
bool JudgeFor(SensorMonitor& monitor, int from, int to, bool agrees) {
  bool used = false;
  for (int ms = from; ms < to; ms += 10) used = monitor.Judge(Millis(ms), agrees);
  return used;
}

TEST(SensorMonitor, LeavesOutASingleBadReadingOnly) {
  SensorMonitor monitor(kParams, kDeadline);
  EXPECT_TRUE(monitor.Judge(Millis(0), true));
  EXPECT_FALSE(monitor.Judge(Millis(10), false));
  EXPECT_TRUE(monitor.Judge(Millis(20), true));
  EXPECT_EQ(monitor.StateAt(Millis(20)), SensorState::kUsed);
}

TEST(SensorMonitor, TakesOutAfterOneSecondOfRejectionInARow) {
  SensorMonitor monitor(kParams, kDeadline);
  JudgeFor(monitor, 0, 1000, false);
  EXPECT_EQ(monitor.StateAt(Millis(990)), SensorState::kUsed);
  monitor.Judge(Millis(1000), false);
  EXPECT_EQ(monitor.StateAt(Millis(1000)), SensorState::kRejected);
}

TEST(SensorMonitor, OneAgreementInBetweenStartsTheSecondAnew) {
  SensorMonitor monitor(kParams, kDeadline);
  JudgeFor(monitor, 0, 600, false);
  monitor.Judge(Millis(600), true);
  JudgeFor(monitor, 610, 1500, false);
  EXPECT_EQ(monitor.StateAt(Millis(1490)), SensorState::kUsed);
}

TEST(SensorMonitor, TakesBackAfterTwoSecondsOfAgreement) {
  SensorMonitor monitor(kParams, kDeadline);
  JudgeFor(monitor, 0, 1010, false);
  EXPECT_FALSE(JudgeFor(monitor, 1010, 3010, true));
  EXPECT_TRUE(monitor.Judge(Millis(3010), true));
  EXPECT_EQ(monitor.StateAt(Millis(3010)), SensorState::kUsed);
}

TEST(SensorMonitor, DoesNotCountSilenceAsRejection) {
  SensorMonitor monitor(kParams, kDeadline);
  monitor.Judge(Millis(0), false);
  monitor.Judge(Millis(1500), false);
  EXPECT_EQ(monitor.StateAt(Millis(1500)), SensorState::kUsed);
}

TEST(SensorMonitor, IsSilentBeforeTheFirstReadingAndPastTheDeadline) {
  SensorMonitor monitor(kParams, kDeadline);
  EXPECT_EQ(monitor.StateAt(Millis(0)), SensorState::kSilent);
  monitor.Judge(Millis(0), true);
  EXPECT_EQ(monitor.StateAt(Millis(50)), SensorState::kUsed);
  EXPECT_EQ(monitor.StateAt(Millis(51)), SensorState::kSilent);
}

TEST(SensorMonitor, StaysOutThroughASilence) {
  SensorMonitor monitor(kParams, kDeadline);
  JudgeFor(monitor, 0, 1010, false);
  EXPECT_FALSE(monitor.Judge(Millis(5000), true));
  EXPECT_EQ(monitor.StateAt(Millis(5000)), SensorState::kRejected);
}

TEST(SensorMonitor, CallsTheSameReadingFrozenOnlyInMotion) {
  SensorMonitor monitor(kParams, kDeadline);
  const Eigen::Vector2d reading(3.0, 4.0);
  EXPECT_FALSE(monitor.IsFrozen(Millis(0), reading, true));
  EXPECT_FALSE(monitor.IsFrozen(Millis(190), reading, true));
  EXPECT_TRUE(monitor.IsFrozen(Millis(201), reading, true));
  EXPECT_FALSE(monitor.IsFrozen(Millis(210), reading, false));
  EXPECT_FALSE(monitor.IsFrozen(Millis(220), Eigen::Vector2d(3.0, 4.001), true));
}

TEST(SensorMonitor, LetsASlowSensorSayTheSameTwice) {
  SensorMonitor monitor(kParams, kDeadline);
  const Eigen::Vector2d reading(3.0, 4.0);
  EXPECT_FALSE(monitor.IsFrozen(Millis(0), reading, true));
  EXPECT_FALSE(monitor.IsFrozen(Millis(300), reading, true));
  EXPECT_TRUE(monitor.IsFrozen(Millis(600), reading, true));
}

}  // namespace
}  // namespace hairpin
