#include "common/bus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

#include "tests/unit/common/sample_messages.hpp"

namespace hairpin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr int64_t kStart = 1'700'000'000'000'000;
constexpr int64_t kMilli = 1'000;
constexpr int64_t kSecond = 1'000'000;

/// A bus that listens to IMU and CONES_LIDAR, and raw bytes sent to it.
class BusUnderTest : public testing::Test {
 protected:
  BusUnderTest() {
    bus_.Subscribe(channels::kImu,
                   [this](const imu_t& message) { heard_.push_back(message.utime); });
    bus_.Subscribe(channels::kConesLidar,
                   [this](const cones_t& message) { heard_.push_back(message.utime); });
  }

  void SendRaw(const char* channel, const std::vector<uint8_t>& bytes) {
    transport_.Publish(channel, bytes.data(), bytes.size());
    transport_.Drain();
  }
  void SendImu(int64_t utime, int32_t sequence, int64_t boot_id = 1) {
    SendRaw("IMU", Encoded(Sample<imu_t>(utime, boot_id, sequence)));
  }
  void SendCones(int64_t utime, int32_t sequence) {
    SendRaw("CONES_LIDAR", Encoded(Sample<cones_t>(utime, 1, sequence)));
  }
  channel_health_t Health(const std::string& channel = "IMU") const {
    for (const channel_health_t& health : bus_.Health()) {
      if (health.channel == channel) return health;
    }
    return {};
  }

  Transport transport_{"memq://"};
  Bus bus_{transport_, "test", 77};
  std::vector<int64_t> heard_;
};

TEST_F(BusUnderTest, FillsInBootIdAndSequence) {
  std::vector<imu_t> received;
  Bus other(transport_, "other", 78);
  other.Subscribe(channels::kImu, [&](const imu_t& message) { received.push_back(message); });
  bus_.Publish(channels::kImu, Sample<imu_t>(kStart, 5, 99));
  bus_.Publish(channels::kImu, Sample<imu_t>(kStart + 1, 5, 99));
  transport_.Drain();
  ASSERT_EQ(received.size(), 2u);
  EXPECT_EQ(received[0].boot_id, 77);
  EXPECT_EQ(received[0].sequence, 0);
  EXPECT_EQ(received[1].sequence, 1);
}

TEST_F(BusUnderTest, RefusesToSubscribeTwiceOrToRefuseWhatItDoesNotHear) {
  EXPECT_THROW(bus_.Subscribe(channels::kImu, [](const imu_t&) {}), std::logic_error);
  EXPECT_THROW(bus_.Refuse(channels::kTrack, "never heard"), std::logic_error);
}

TEST_F(BusUnderTest, CountsWhatTheNodeRefuses) {
  bus_.Refuse(channels::kImu, "out of range");
  EXPECT_EQ(Health().refused, 1);
}

TEST_F(BusUnderTest, DropsAndCountsWhatIsNotOfTheChannelsType) {
  SendRaw("IMU", {});
  SendRaw("IMU", {1, 2, 3});
  SendRaw("IMU", Encoded(Sample<cones_t>(kStart)));
  std::vector<uint8_t> bytes = Encoded(Sample<imu_t>(kStart));
  bytes[0] ^= 1;
  SendRaw("IMU", bytes);
  EXPECT_EQ(Health().undecodable, 4);
  EXPECT_EQ(Health().received, 0);
  EXPECT_TRUE(heard_.empty());
}

TEST_F(BusUnderTest, DropsAndCountsTruncatedTrailingAndNanPayloads) {
  std::vector<uint8_t> bytes = Encoded(Sample<imu_t>(kStart));
  bytes.push_back(0);
  SendRaw("IMU", bytes);
  bytes.resize(bytes.size() - 2);
  SendRaw("IMU", bytes);
  imu_t message = Sample<imu_t>(kStart);
  message.angular_rate_radps[2] = std::numeric_limits<double>::quiet_NaN();
  SendRaw("IMU", Encoded(message));
  EXPECT_EQ(Health().undecodable, 3);
  SendImu(kStart, 0);
  EXPECT_THAT(heard_, ElementsAre(kStart)) << "and hears the next good one";
}

TEST_F(BusUnderTest, SurvivesTenThousandMutatedMessages) {
  const std::vector<uint8_t> good = Encoded(Sample<cones_t>(kStart));
  std::mt19937 random(1);
  for (int i = 0; i < 10'000; ++i) {
    std::vector<uint8_t> bytes = good;
    for (auto flips = 1 + random() % 6; flips > 0; --flips)
      bytes[random() % bytes.size()] = static_cast<uint8_t>(random());
    if (random() % 8 == 0) bytes.resize(random() % bytes.size());
    SendRaw("CONES_LIDAR", bytes);
  }
  const channel_health_t health = Health("CONES_LIDAR");
  EXPECT_EQ(health.received + health.undecodable + health.duplicates + health.implausible_time,
            10'000);
  EXPECT_EQ(heard_.size(), static_cast<size_t>(health.received));
}

TEST_F(BusUnderTest, DropsDuplicatesAndPassesReorderedMessages) {
  for (const int32_t sequence : {0, 1, 3, 2, 2, 3, 0, 4})
    SendImu(kStart + sequence * kMilli, sequence);
  EXPECT_THAT(heard_, ElementsAre(kStart, kStart + kMilli, kStart + 3 * kMilli, kStart + 2 * kMilli,
                                  kStart + 4 * kMilli));
  EXPECT_EQ(Health().duplicates, 3);
  EXPECT_EQ(Health().missing, 0) << "the gap was filled late";
}

TEST_F(BusUnderTest, CountsGaps) {
  for (const int32_t sequence : {0, 1, 4, 5, 9}) SendImu(kStart + sequence * kMilli, sequence);
  EXPECT_EQ(Health().missing, 5);
}

TEST_F(BusUnderTest, TakesAMessageForADuplicateThatIsOlderThanItsWindow) {
  SendImu(kStart, 100);
  SendImu(kStart, 37);
  EXPECT_EQ(Health().received, 2) << "63 back: the edge of the window";
  SendImu(kStart, 36);
  EXPECT_EQ(Health().duplicates, 1);
}

TEST_F(BusUnderTest, IsNotDeafenedForEverByOneCorruptSequence) {
  SendImu(kStart, 0);
  SendImu(kStart, std::numeric_limits<int32_t>::max());
  for (int32_t sequence = 1; sequence <= 20; ++sequence)
    SendImu(kStart + sequence * kMilli, sequence);
  EXPECT_EQ(Health().duplicates, 20);
  for (int32_t sequence = 21; sequence <= 30; ++sequence)
    SendImu(kStart + sequence * kMilli, sequence);
  EXPECT_EQ(Health().received, 12);
}

TEST_F(BusUnderTest, CountsSendersByTheirBootIdAndKeepsThemApart) {
  for (int64_t boot = 1; boot <= 3; ++boot) SendImu(kStart, 0, boot);
  SendImu(kStart, 1, 1);
  EXPECT_EQ(Health().senders, 3);
  EXPECT_EQ(Health().received, 4);
  EXPECT_EQ(Health().missing, 0);
}

TEST_F(BusUnderTest, StaysBoundedWhenEachMessageHasAnotherSender) {
  for (int64_t boot = 0; boot < 1000; ++boot) SendImu(kStart, 0, boot);
  EXPECT_EQ(Health().received, 1000);
  SendImu(kStart, 0, 999);
  EXPECT_EQ(Health().duplicates, 1) << "the last are remembered";
}

TEST_F(BusUnderTest, DataTimeIsTheNewestOnAnyChannelAndDoesNotGoBack) {
  std::vector<int64_t> advances;
  bus_.OnDataTime([&](int64_t utime) { advances.push_back(utime); });
  SendImu(kStart, 0);
  SendCones(kStart + kSecond, 0);
  SendImu(kStart + kMilli, 1);
  SendImu(kStart - 3600 * kSecond, 2);
  EXPECT_THAT(advances, ElementsAre(kStart, kStart + kSecond));
  EXPECT_EQ(bus_.newest_utime(), kStart + kSecond);
  EXPECT_EQ(heard_.size(), 4u) << "late messages pass: they are the node's to judge";
}

TEST_F(BusUnderTest, DropsTimesThatCannotBe) {
  SendImu(kStart, 0);
  int32_t sequence = 1;
  for (const int64_t utime : {int64_t{-1}, std::numeric_limits<int64_t>::min(),
                              std::numeric_limits<int64_t>::max(), kStart + 10 * kSecond + 1}) {
    SendImu(utime, sequence++);
  }
  EXPECT_EQ(Health().implausible_time, 4);
  EXPECT_EQ(bus_.newest_utime(), kStart);
  SendImu(kStart + 10 * kSecond, sequence);
  EXPECT_EQ(bus_.newest_utime(), kStart + 10 * kSecond);
}

TEST_F(BusUnderTest, IsNotPoisonedByAnAbsurdFirstTime) {
  SendImu(std::numeric_limits<int64_t>::max(), 0);
  SendImu(kStart, 1);
  EXPECT_EQ(bus_.newest_utime(), kStart);
}

TEST_F(BusUnderTest, FollowsAJumpOfTimeOnlyWhenTheChannelInsists) {
  SendImu(kStart, 0);
  const int64_t later = kStart + 3600 * kSecond;
  for (int32_t i = 0; i < 20; ++i) SendImu(later + i * kMilli, 1 + i);
  EXPECT_EQ(bus_.newest_utime(), kStart);
  SendImu(later + 20 * kMilli, 21);
  EXPECT_EQ(bus_.newest_utime(), later + 20 * kMilli);
}

TEST_F(BusUnderTest, DoesNotFollowTimesThatJumpAbout) {
  SendImu(kStart, 0);
  std::mt19937_64 random(5);
  for (int32_t i = 1; i < 1000; ++i) SendImu(static_cast<int64_t>(random() >> 1), i);
  EXPECT_EQ(bus_.newest_utime(), kStart);
}

TEST_F(BusUnderTest, StartsToInsistAnewAfterAGoodTime) {
  SendImu(kStart, 0);
  const int64_t later = kStart + 3600 * kSecond;
  for (int32_t i = 1; i < 1000; ++i) SendImu(i % 20 == 0 ? kStart : later + i * kMilli, i);
  EXPECT_EQ(bus_.newest_utime(), kStart);
}

TEST_F(BusUnderTest, TakesTimeZeroForNoTime) {
  SendImu(0, 0);
  EXPECT_EQ(Health().received, 1);
  EXPECT_EQ(bus_.newest_utime(), 0);
}

TEST_F(BusUnderTest, WarnsAtMostOnceASecondOfDataTime) {
  testing::internal::CaptureStderr();
  for (int32_t i = 0; i < 250; ++i) {
    SendCones(kStart + i * 10 * kMilli, i);
    SendRaw("IMU", {1});
  }
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_THAT(text, HasSubstr("test: IMU: dropped: is no imu_t"));
}

TEST(BusOfAThrowingHandler, IsIntactAfterTheExceptionWasRethrown) {
  Transport transport("memq://");
  Bus bus(transport, "test", 1);
  Bus sender(transport, "sender", 2);
  int heard = 0;
  bus.Subscribe(channels::kImu, [&](const imu_t&) {
    if (++heard % 2 == 1) throw std::runtime_error("broken invariant");
  });
  for (int i = 0; i < 4; ++i) sender.Publish(channels::kImu, Sample<imu_t>(kStart + i));
  EXPECT_THROW(transport.Handle(0), std::runtime_error);
  EXPECT_TRUE(transport.Handle(0));
  EXPECT_THROW(transport.Drain(), std::runtime_error);
  EXPECT_NO_THROW(transport.Drain());
  EXPECT_EQ(heard, 4);
}

TEST(Transport, DeliversInTheOrderOfPublicationAcrossChannelsIncludingWhatHandlersPublish) {
  Transport transport("memq://");
  Bus bus(transport, "test", 1);
  std::vector<std::string> order;
  bus.Subscribe(channels::kImu, [&](const imu_t& message) {
    order.push_back("IMU");
    bus.Publish(channels::kVelocity, Sample<velocity_t>(message.utime));
  });
  bus.Subscribe(channels::kGnss, [&](const gnss_t&) { order.push_back("GNSS"); });
  bus.Subscribe(channels::kVelocity, [&](const velocity_t&) { order.push_back("VELOCITY"); });
  bus.Publish(channels::kImu, Sample<imu_t>(kStart));
  bus.Publish(channels::kGnss, Sample<gnss_t>(kStart));
  transport.Drain();
  EXPECT_THAT(order, ElementsAre("IMU", "GNSS", "VELOCITY"));
}

TEST(Transport, EndsASubscriptionWithItsHandle) {
  Transport transport("memq://");
  int heard = 0;
  auto subscription =
      transport.Subscribe("A.*", [&](const std::string&, const uint8_t*, size_t) { ++heard; });
  const uint8_t byte = 0;
  transport.Publish("AB", &byte, 1);
  transport.Drain();
  subscription.reset();
  transport.Publish("AB", &byte, 1);
  transport.Drain();
  EXPECT_EQ(heard, 1);
}

TEST(Transport, RefusesAUrlThatItCannotOpenWithAHint) {
  try {
    Transport("nonsense://");
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("multicast route"));
  }
}

TEST(Bus, ReportsAnInputThatIsNoChannelBesideTheChannels) {
  Transport transport("memq://");
  Bus bus(transport, "driver", 1);
  channel_health_t& health = bus.AddInput("packets");
  health.received = 7;
  ASSERT_EQ(bus.Health().size(), 1u);
  EXPECT_EQ(bus.Health().front().channel, "packets");
  EXPECT_EQ(bus.Health().front().received, 7);
  EXPECT_THROW(bus.AddInput("packets"), std::logic_error);
}

TEST(Bus, TakesADriversOwnMeasurementsForData) {
  Transport transport("memq://");
  Bus bus(transport, "driver", 1);
  int64_t heard = 0;
  bus.OnDataTime([&](int64_t utime) { heard = utime; });
  bus.AdvanceDataTime(5'000'000);
  bus.AdvanceDataTime(4'000'000);
  EXPECT_EQ(bus.newest_utime(), 5'000'000);
  EXPECT_EQ(heard, 5'000'000);
}

}  // namespace
}  // namespace hairpin
