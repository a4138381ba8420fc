#include "daemons/watchdog/source.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "tests/unit/watchdog/traffic.hpp"

namespace hairpin {
namespace {

constexpr int64_t kT0 = 1'000'000'000;
constexpr int64_t kMilli = 1000;

class ConeSource : public testing::Test {
 protected:
  // Messages at 10 Hz up to `end_ms`, heard as soon as they are measured.
  void SendTo(int64_t end_ms) {
    for (; next_ms_ <= end_ms; next_ms_ += 100) Send(next_ms_, sequence_++);
  }
  void Send(int64_t ms, int64_t sequence) {
    source_.Hear({kT0 + ms * kMilli, 1, sequence}, kT0 + ms * kMilli);
  }
  static int64_t At(int64_t ms) { return kT0 + ms * kMilli; }

  Source source_{{"CONES", 10.0, 0.25}, TestWatchdogParams().source};
  int64_t next_ms_ = 0;
  int64_t sequence_ = 0;
};

TEST_F(ConeSource, IsFreshUpToItsDeadlineAndStaleBeyond) {
  EXPECT_FALSE(source_.Fresh(At(0)));
  SendTo(0);
  EXPECT_TRUE(source_.Fresh(At(249)));
  EXPECT_TRUE(source_.Fresh(At(250)));
  EXPECT_FALSE(source_.Fresh(At(251)));
}

TEST_F(ConeSource, IsHealthyAfterASecondWithoutALapse) {
  SendTo(900);
  EXPECT_FALSE(source_.Healthy(At(990)));
  SendTo(1000);
  EXPECT_TRUE(source_.Healthy(At(1000)));
}

TEST_F(ConeSource, IsOnProbationAgainAfterALapse) {
  SendTo(1000);
  source_.Advance(At(1251));
  next_ms_ = 1260;
  SendTo(2160);
  EXPECT_FALSE(source_.Healthy(At(2250)));
  SendTo(2260);
  EXPECT_TRUE(source_.Healthy(At(2260)));
}

TEST_F(ConeSource, LapsesByAGapEvenWhereNobodyLooked) {
  SendTo(1000);
  next_ms_ = 1400;
  SendTo(1400);
  EXPECT_TRUE(source_.Fresh(At(1400)));
  EXPECT_FALSE(source_.Healthy(At(1400)));
}

TEST_F(ConeSource, StaysHealthyWhereOnlyMessagesWereLostOnTheWay) {
  SendTo(1000);
  source_.Advance(At(1260));
  Send(1300, sequence_ + 2);  // two lost, the sender kept its rate
  EXPECT_TRUE(source_.Healthy(At(1300)));
}

TEST_F(ConeSource, DoesNotTakeASlowSenderForLosses) {
  SendTo(1000);
  Send(1500, sequence_ + 1);
  EXPECT_FALSE(source_.Healthy(At(1500)));
}

TEST_F(ConeSource, DoesNotTakeALongOutageForLosses) {
  SendTo(1000);
  Send(1600, sequence_ + 5);
  EXPECT_FALSE(source_.Healthy(At(1600)));
}

TEST_F(ConeSource, IsNeverHealthyWhenEachMessageGoesStaleBeforeTheNext) {
  for (int64_t ms = 0; ms < 5000; ms += 100) {
    source_.Hear({kT0 + ms * kMilli, 1, sequence_++}, At(ms + 220));
    source_.Advance(At(ms + 260));
    EXPECT_FALSE(source_.Healthy(At(ms + 220)));
  }
}

TEST_F(ConeSource, TakesALateMessageForNoNewerThanItIs) {
  SendTo(1000);
  Send(800, 100);
  EXPECT_FALSE(source_.Fresh(At(1251)));
}

TEST_F(ConeSource, IsLateAfterMoreThanThreeMessagesPastTheDeadline) {
  for (int i = 0; i < 3; ++i) source_.Hear({At(100 * i), 1, i}, At(100 * i + 251));
  EXPECT_FALSE(source_.late());
  source_.Hear({At(300), 1, 3}, At(551));
  EXPECT_TRUE(source_.late());
  source_.Hear({At(400), 1, 4}, At(650));
  EXPECT_FALSE(source_.late());
}

TEST(AnsweringSource, AgesFromTheFirstQuestionItHasNotAnswered) {
  SourceSpec spec{"TRACK", 10.0, 0.25};
  spec.answers = {"LOCAL_MAP"};
  Source source(spec, TestWatchdogParams().source);
  source.Await(kT0);
  EXPECT_EQ(source.Age(kT0 + 5000 * kMilli), 0.0) << "never heard";
  source.Hear({kT0, 1, 0}, kT0);
  EXPECT_EQ(source.Age(kT0 + 5000 * kMilli), 0.0) << "nothing asked";
  source.Await(kT0 + 5000 * kMilli);
  source.Await(kT0 + 5100 * kMilli);
  EXPECT_DOUBLE_EQ(source.Age(kT0 + 5200 * kMilli), 0.2);
}

// Messages of `total` heard until the alarm at this loss, or `total`.
int MessagesToAlarm(double loss, int total, uint32_t seed) {
  LossDetector detector(0.05, 0.2, 10.0);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < total; ++i) {
    if (uniform(random) < loss) continue;
    detector.Add({0, 1, i});
    if (detector.alarmed()) return i;
  }
  return total;
}

TEST(LossDetector, IsSilentAtOneAndAtFivePercent) {
  for (const double loss : {0.0, 0.01, 0.05}) {
    for (uint32_t seed = 1; seed <= 10; ++seed)
      EXPECT_EQ(MessagesToAlarm(loss, 6000, seed), 6000) << loss << " " << seed;
  }
}

TEST(LossDetector, RaisesTheAlarmAtTwentyPercentWithinTwoSecondsAtHundredHertz) {
  for (uint32_t seed = 1; seed <= 50; ++seed)
    EXPECT_LT(MessagesToAlarm(0.2, 1000, seed), 250) << seed;
}

TEST(LossDetector, CallsItOffOnceTheLossesEnd) {
  LossDetector detector(0.05, 0.2, 10.0);
  int64_t sequence = 0;
  while (!detector.alarmed()) detector.Add({0, 1, sequence += 2});
  for (int i = 0; i < 60; ++i) detector.Add({0, 1, ++sequence});
  EXPECT_FALSE(detector.alarmed());
}

TEST(LossDetector, DoesNotTakeAnOutageOrARestartForLosses) {
  LossDetector detector(0.05, 0.2, 10.0);
  detector.Add({0, 1, 0});
  detector.Add({0, 1, 2'000'000'000});
  EXPECT_FALSE(detector.alarmed());
  detector.Add({0, 2, 0});
  detector.Add({0, 2, 1});
  EXPECT_FALSE(detector.alarmed());
}

TEST(LossDetector, TakesBackALossThatArrivesLate) {
  LossDetector detector(0.05, 0.2, 10.0);
  for (int64_t sequence = 0; sequence < 1000; sequence += 2) {
    detector.Add({0, 1, sequence + 1});
    detector.Add({0, 1, sequence});
  }
  EXPECT_FALSE(detector.alarmed());
}

TEST(LossDetector, RefusesSharesThatAreNone) {
  EXPECT_THROW(LossDetector(0.0, 0.2, 10.0), std::invalid_argument);
  EXPECT_THROW(LossDetector(0.2, 0.2, 10.0), std::invalid_argument);
  EXPECT_THROW(LossDetector(0.05, 1.0, 10.0), std::invalid_argument);
  EXPECT_THROW(LossDetector(0.05, 0.2, 0.0), std::invalid_argument);
}

TEST(BootTracker, TakesARestartForNoSecondPublisher) {
  BootTracker boots(TestWatchdogParams().source);
  for (const int64_t boot : {1, 1, 1, 2, 2, 2, 3, 3}) boots.Add(kT0, boot);
  EXPECT_FALSE(boots.suspects_second_publisher(kT0));
  EXPECT_FALSE(boots.has_second_publisher(kT0));
}

TEST(BootTracker, SuspectsAStragglerAndNoMore) {
  BootTracker boots(TestWatchdogParams().source);
  for (const int64_t boot : {1, 1, 2, 1, 2, 2, 2}) boots.Add(kT0, boot);
  EXPECT_TRUE(boots.suspects_second_publisher(kT0));
  EXPECT_FALSE(boots.has_second_publisher(kT0));
}

TEST(BootTracker, KnowsASecondPublisherByItsAlternation) {
  BootTracker boots(TestWatchdogParams().source);
  for (const int64_t boot : {1, 2, 1, 2, 1}) boots.Add(kT0, boot);
  EXPECT_TRUE(boots.has_second_publisher(kT0));
  EXPECT_TRUE(boots.has_second_publisher(kT0 + 5'000'000));
  EXPECT_FALSE(boots.has_second_publisher(kT0 + 5'000'001)) << "it has ended";
}

TEST(BootTracker, KnowsARestartLoop) {
  BootTracker boots(TestWatchdogParams().source);
  for (int64_t boot = 0; boot < 5; ++boot) boots.Add(kT0 + boot * 2'000'000, boot);
  EXPECT_FALSE(boots.in_restart_loop(kT0 + 8'000'000)) << "four restarts";
  boots.Add(kT0 + 10'000'000, 5);
  EXPECT_TRUE(boots.in_restart_loop(kT0 + 10'000'000));
}

}  // namespace
}  // namespace hairpin
