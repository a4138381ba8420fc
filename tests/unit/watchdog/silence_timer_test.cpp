#include "daemons/watchdog/silence_timer.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace hairpin {
namespace {

class Silence : public testing::Test {
 protected:
  // Polls each 10 ms for `ms`, and counts the announcements.
  int Pass(int ms) {
    int announced = 0;
    for (int i = 0; i < ms; i += 10) announced += timer_.Poll(clock_ += 10'000) ? 1 : 0;
    return announced;
  }

  SilenceTimer timer_{0.5, 0.02};
  int64_t clock_ = 123'456'789;
};

TEST_F(Silence, IsAnnouncedFromItsLimitOnAndRepeated) {
  timer_.Poll(clock_);
  EXPECT_EQ(Pass(490), 0);
  EXPECT_EQ(Pass(10), 1);
  EXPECT_EQ(Pass(100), 5);
}

TEST_F(Silence, EndsWithTheFirstNews) {
  Pass(1000);
  timer_.Heard();
  EXPECT_EQ(Pass(490), 0);
  EXPECT_EQ(Pass(20), 1);
}

TEST_F(Silence, IsNotWhatPassesWhileTheProcessStands) {
  timer_.Poll(clock_);
  EXPECT_FALSE(timer_.Poll(clock_ += 3'600'000'000));
  EXPECT_EQ(Pass(390), 0) << "the hour counted as 0.1 s";
  EXPECT_EQ(Pass(10), 1);
}

TEST_F(Silence, IsNotMadeOrEndedByAClockThatGoesBack) {
  Pass(410);
  EXPECT_FALSE(timer_.Poll(clock_ -= 1'000'000));
  EXPECT_EQ(Pass(90), 0);
  EXPECT_EQ(Pass(10), 1);
}

TEST(SilenceTimer, RefusesTimesThatAreNone) {
  EXPECT_THROW(SilenceTimer(0.0, 0.02), std::invalid_argument);
  EXPECT_THROW(SilenceTimer(0.5, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
