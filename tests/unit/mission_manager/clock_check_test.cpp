// FAULTS row 20 before the start: a sensor whose clock is not the others'.
#include "daemons/mission_manager/clock_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace hairpin {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr int64_t kStart = 1'700'000'000'000'000;

class Clocks : public testing::Test {
 protected:
  // Sensors at 100 Hz whose clocks are off by so many ms, each message `late` more.
  void Run(double seconds, int64_t imu_ms, int64_t motors_ms, int64_t steering_ms) {
    for (int i = 0; i < static_cast<int>(seconds * 100.0); ++i) {
      now_ += 10'000;
      const int64_t late = i % 7 == 0 ? 0 : 1'000 * (i % 30);
      Hear("IMU", now_ + 1'000 * imu_ms - late);
      Hear("MOTORS", now_ + 1'000 * motors_ms - late);
      Hear("STEERING", now_ + 1'000 * steering_ms - late);
    }
  }
  void Hear(const std::string& channel, int64_t utime) {
    newest_ = std::max(newest_, utime);
    check_.Heard(channel, utime, newest_);
  }

  ClockCheck check_{{{"IMU", 0.05}, {"MOTORS", 0.05}, {"STEERING", 0.05}}, 1.0};
  int64_t now_ = kStart;
  int64_t newest_ = 0;
};

TEST_F(Clocks, ThatAgreeAreFineHoweverLateTheMessagesComeAtTimes) {
  Run(5.0, 0, 0, 0);
  EXPECT_THAT(check_.Problems(), IsEmpty());
}

TEST_F(Clocks, WithinToleranceAreFine) {
  Run(5.0, 0, -45, 0);
  EXPECT_THAT(check_.Problems(), IsEmpty());
}

TEST_F(Clocks, ThatAreBehindAreNamed) {
  Run(5.0, 0, -80, 0);
  EXPECT_THAT(check_.Problems(), ElementsAre("the clock of MOTORS is 80 ms behind the others"));
}

TEST_F(Clocks, ThatAreAheadAreNamedThoughItIsTheOthersWhoLookLate) {
  Run(5.0, 120, 0, 0);
  EXPECT_THAT(check_.Problems(), ElementsAre("the clock of IMU is 120 ms ahead of the others"));
}

TEST_F(Clocks, ThatAreSetRightAreFineAgainAfterTwoWindows) {
  Run(5.0, 0, -80, 0);
  Run(2.0, 0, 0, 0);
  EXPECT_THAT(check_.Problems(), IsEmpty());
}

TEST_F(Clocks, OfTwoSensorsCannotBeJudged) {
  Hear("IMU", kStart);
  Hear("MOTORS", kStart - 900'000);
  Hear("no sensor", kStart - 5'000'000);
  EXPECT_THAT(check_.Problems(), IsEmpty());
}

TEST(ClockCheck, RefusesValuesOutOfBounds) {
  EXPECT_THROW(ClockCheck({{"IMU", 0.0}}, 1.0), std::invalid_argument);
  EXPECT_THROW(ClockCheck({}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
