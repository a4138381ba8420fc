#include "daemons/mission_manager/rate_monitor.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace hairpin {
namespace {

constexpr RateMonitorParams kParams{.window = 1.0, .min_share = 0.8};
constexpr int64_t kStart = 1'000'000'000;

TEST(RateMonitor, IsContentAfterAWindowAtTheRate) {
  RateMonitor monitor("TRACK", 10.0, 0.25, kParams);
  EXPECT_EQ(monitor.Problem(kStart), "TRACK was never heard");
  int64_t now = kStart;
  for (; now < kStart + 1'000'000; now += 100'000) {
    monitor.Heard(now);
    EXPECT_EQ(monitor.Problem(now), "TRACK has just begun");
  }
  monitor.Heard(now);
  EXPECT_EQ(monitor.Problem(now), "");
  EXPECT_EQ(monitor.Problem(now + 250'000), "");
  EXPECT_EQ(monitor.Problem(now + 250'001), "TRACK is stale");
}

TEST(RateMonitor, BearsOneMessageLostAndNoLongerGap) {
  RateMonitor monitor("TRACK", 10.0, 0.25, kParams);
  for (int i = 0; i <= 20; ++i) {
    if (i != 15) monitor.Heard(kStart + i * 100'000);
  }
  EXPECT_EQ(monitor.Problem(kStart + 2'000'000), "");
  monitor.Heard(kStart + 2'300'000);
  EXPECT_EQ(monitor.Problem(kStart + 2'300'000), "TRACK has just begun");
}

TEST(RateMonitor, RefusesASlowChannel) {
  RateMonitor monitor("TRACK", 10.0, 0.25, kParams);
  for (int i = 0; i <= 20; ++i) monitor.Heard(kStart + i * 200'000);
  EXPECT_EQ(monitor.Problem(kStart + 4'000'000), "TRACK is too slow");
}

TEST(RateMonitor, RefusesWrongParameters) {
  EXPECT_THROW(RateMonitor("X", 0.0, 0.25, kParams), std::invalid_argument);
  EXPECT_THROW(RateMonitor("X", 10.0, 0.0, kParams), std::invalid_argument);
  EXPECT_THROW(RateMonitor("X", 10.0, 0.25, {0.0, 0.8}), std::invalid_argument);
  EXPECT_THROW(RateMonitor("X", 10.0, 0.25, {1.0, 1.1}), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
