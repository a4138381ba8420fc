#include "daemons/lidar_driver/lidar_driver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/lidar_setup.hpp"
#include "tests/support/velodyne_packets.hpp"

namespace hairpin {
namespace {

constexpr int64_t kNow = 1'700'000'000'000'000;
constexpr int kPacketsPerTurn = 151;

int64_t Count(const LidarDriver& driver, Refusal reason) {
  return driver.refused()[static_cast<size_t>(reason)];
}

/// A driver without GPS time, fed with good packets and what the tests do to them.
class Vlp32cDriver : public testing::Test {
 protected:
  LidarDriverResult Feed(const Bytes& packet, std::optional<uint32_t> sender = {}) {
    auto result = driver_.Add({packet, kNow, sender});
    if (result.revolution) revolutions_.push_back(std::move(*result.revolution));
    return result;
  }
  void FeedTurns(double turns) {
    for (int i = 0; i < static_cast<int>(turns * kPacketsPerTurn); ++i) Feed(source_.Next());
  }
  Refusal ReasonOf(const Bytes& packet) {
    const auto result = Feed(packet);
    return result.refused ? result.refused->reason : Refusal::kCount;
  }

  VelodyneSource source_;
  LidarDriver driver_ = MakeDriver(Vlp32c());
  std::vector<Revolution> revolutions_;
};

TEST_F(Vlp32cDriver, MakesAWholeRevolutionOfEveryTurn) {
  FeedTurns(4.5);
  ASSERT_EQ(revolutions_.size(), 4u);
  for (const Revolution& revolution : revolutions_) {
    EXPECT_NEAR(revolution.covered_share, 1.0, 1e-3);
    EXPECT_NEAR(static_cast<double>(revolution.points.size()), 36000.0 / 19.90656 * 32, 64);
    EXPECT_EQ(revolution.refused, 0);
    EXPECT_NEAR(revolution.points.front().age, 0.1f, 1e-3f);
    EXPECT_NEAR(revolution.points.back().age, 0.0f, 1e-4f);
  }
  EXPECT_NEAR(static_cast<double>(revolutions_[1].utime - revolutions_[0].utime), 100'000, 60);
}

TEST_F(Vlp32cDriver, SeesWhereTheLasersLook) {
  const VelodyneDecoder decoder(Vlp32c());
  DecodedPacket decoded;
  source_.azimuth = 9000.0;  // to the right
  ASSERT_FALSE(decoder.Decode(source_.Next(), decoded));
  ASSERT_EQ(decoded.points.size(), 384u);
  const LidarPoint& first = decoded.points[0];  // laser 0: 25 degrees down, 1.4 degrees on
  EXPECT_EQ(first.ring, 0);
  EXPECT_NEAR(first.position.z(), -10.0 * std::sin(0.436332), 1e-3);
  EXPECT_NEAR(first.position.y(), -10.0 * std::cos(0.436332) * std::cos(0.0244346), 1e-3);
  EXPECT_NEAR(first.position.x(), -10.0 * std::cos(0.436332) * std::sin(0.0244346), 1e-3);
  // Laser 31 fires in the sixteenth pair, when the head has turned by 15 / 24 of a block.
  EXPECT_NEAR(decoded.points[31].age, 15 * 2.304e-6, 1e-8);
  const double azimuth =
      std::atan2(-decoded.points[31].position.y(), decoded.points[31].position.x()) * 180.0 /
      std::numbers::pi;
  EXPECT_NEAR(azimuth, 90.0 - 1.4 + 0.19 * 15.0 / 24.0, 0.006);
}

TEST_F(Vlp32cDriver, TakesBothReturnsInDualMode) {
  source_.mode = 0x39;
  const VelodyneDecoder decoder(Vlp32c());
  DecodedPacket decoded;
  ASSERT_FALSE(decoder.Decode(source_.Next(), decoded));
  EXPECT_EQ(decoded.points.size(), 384u);
  EXPECT_EQ(decoded.columns.size(), 6u);
  EXPECT_NEAR(decoded.points[0].position.norm(), 10.0f, 1e-3f);
  EXPECT_NEAR(decoded.points[1].position.norm(), 11.0f, 1e-3f);
}

TEST_F(Vlp32cDriver, RefusesAndCountsWhatIsMalformed) {
  Bytes packet = source_.Next();
  EXPECT_EQ(ReasonOf(Bytes(packet.begin(), packet.end() - 1)), Refusal::kSize);
  EXPECT_EQ(ReasonOf({}), Refusal::kSize);
  Bytes bad = packet;
  bad.push_back(0);
  EXPECT_EQ(ReasonOf(bad), Refusal::kSize);
  bad = packet;
  bad[1205] = 0x22;
  EXPECT_EQ(ReasonOf(bad), Refusal::kModel);
  bad = packet;
  bad[1204] = 0x40;
  EXPECT_EQ(ReasonOf(bad), Refusal::kReturnMode);
  bad = packet;
  bad[1101] = 0xdd;
  EXPECT_EQ(ReasonOf(bad), Refusal::kFlag);
  bad = packet;
  Put(bad, 1102, 36000, 2);
  EXPECT_EQ(ReasonOf(bad), Refusal::kAzimuth);
  bad = packet;
  bad[1204] = 0x39;  // dual: blocks must come in pairs
  EXPECT_EQ(ReasonOf(bad), Refusal::kAzimuth);
  bad = packet;
  Put(bad, 1200, 3'600'000'000u, 4);
  EXPECT_EQ(ReasonOf(bad), Refusal::kTime);
  EXPECT_EQ(Count(driver_, Refusal::kSize), 3);
  EXPECT_EQ(Count(driver_, Refusal::kAzimuth), 2);
  EXPECT_EQ(driver_.used(), 0);
}

TEST(LidarDriver, RefusesAForeignSender) {
  LidarDriverParams params{{0.0, 10.0, 1.0}, {2.0, 0.3}, 0x0a000001u};
  LidarDriver driver(params, std::make_unique<VelodyneDecoder>(Vlp32c()));
  VelodyneSource source;
  const Bytes packet = source.Next();
  const auto result = driver.Add({packet, kNow, 0x0a000002u});
  ASSERT_TRUE(result.refused);
  EXPECT_EQ(result.refused->what, "packet from 10.0.0.2");
  EXPECT_FALSE(driver.Add({packet, kNow, 0x0a000001u}).refused);
}

// FAULTS 12
TEST_F(Vlp32cDriver, GivesUpARevolutionOfWhichMoreThanThirtyPercentAreBad) {
  for (const auto& [bad_of_ten, published] : {std::pair{2, true}, {4, false}}) {
    driver_ = MakeDriver(Vlp32c());
    revolutions_.clear();
    for (int i = 0; i < 3 * kPacketsPerTurn; ++i) {
      Bytes packet = source_.Next();
      if (i % 10 < bad_of_ten) packet[0] = 0;
      Feed(packet);
    }
    EXPECT_EQ(!revolutions_.empty(), published) << bad_of_ten;
    EXPECT_EQ(driver_.given_up() > 0, !published) << bad_of_ten;
  }
}

// FAULTS 11
TEST_F(Vlp32cDriver, PublishesNothingOfAFrozenSensor) {
  std::vector<Bytes> turn;
  for (int i = 0; i < kPacketsPerTurn; ++i) turn.push_back(source_.Next());
  for (const Bytes& packet : turn) Feed(packet);
  const size_t before = revolutions_.size();
  for (int loop = 0; loop < 30; ++loop)
    for (const Bytes& packet : turn) Feed(packet);
  EXPECT_EQ(revolutions_.size(), before);
  EXPECT_EQ(Count(driver_, Refusal::kFrozen), 30 * kPacketsPerTurn);
}

// FAULTS 11
TEST_F(Vlp32cDriver, PublishesNothingOfAHeadThatStandsStill) {
  FeedTurns(1.2);
  const size_t before = revolutions_.size();
  source_.block_turn = 0.0;
  FeedTurns(3.0);
  EXPECT_EQ(revolutions_.size(), before);
  EXPECT_GE(Count(driver_, Refusal::kFrozen), 3 * kPacketsPerTurn - 1);
}

TEST_F(Vlp32cDriver, BelievesASensorThatWasRestarted) {
  FeedTurns(2.0);
  source_.time_us = 0;
  FeedTurns(9.0);
  const size_t before = revolutions_.size();
  FeedTurns(5.0);
  EXPECT_GE(revolutions_.size(), before + 4);
}

TEST_F(Vlp32cDriver, SaysHowMuchOfARevolutionWasLost) {
  for (int i = 0; i < 4 * kPacketsPerTurn; ++i) {
    const Bytes packet = source_.Next();
    if (i % 5 != 0) Feed(packet);
  }
  ASSERT_GE(revolutions_.size(), 2u);
  EXPECT_NEAR(revolutions_[1].covered_share, 0.8, 0.01);
}

TEST_F(Vlp32cDriver, MakesNoRevolutionOfTwoHalves) {
  FeedTurns(1.2);
  const size_t before = revolutions_.size();
  // Nothing for a turn and a half.
  for (int i = 0; i < 3 * kPacketsPerTurn / 2; ++i) source_.Next();
  FeedTurns(1.3);
  for (size_t i = before; i < revolutions_.size(); ++i)
    EXPECT_NEAR(revolutions_[i].covered_share, 1.0, 1e-3);
}

TEST_F(Vlp32cDriver, GoesOnOverTheTopOfTheHour) {
  source_.time_us = 3'599'850'000u;
  FeedTurns(4.0);
  ASSERT_GE(revolutions_.size(), 3u);
  for (size_t i = 1; i < revolutions_.size(); ++i)
    EXPECT_NEAR(static_cast<double>(revolutions_[i].utime - revolutions_[i - 1].utime), 100'000,
                60);
}

const std::string kRmc = "GPRMC,101723,A,4930.0,N,00834.0,E,000.0,000.0,241126,,,A";
constexpr int64_t kRmcUtime = 1'795'515'443'000'000;  // 2026-11-24 10:17:23

TEST(SensorTime, IsGnssTimeOnceThePositionPacketHasSaidTheHour) {
  LidarDriver driver = MakeDriver(Vlp32c(), 120.0, 3.0);
  VelodyneSource source;
  source.time_us = 1'043'400'000u;  // 17:23.4
  const auto feed = [&](const Bytes& packet) { return driver.Add({packet, kNow, {}}); };
  feed(source.Next());
  EXPECT_FALSE(driver.utime());
  feed(VelodynePosition(source.time_us, kRmc, 0));                            // no pulse
  feed(VelodynePosition(source.time_us, "GPRMC,101723,V,,,,,,,241126,,,N"));  // no fix
  EXPECT_FALSE(driver.utime());
  feed(VelodynePosition(source.time_us, kRmc));
  EXPECT_EQ(driver.utime(), kRmcUtime + 400'000);
  EXPECT_EQ(driver.time_source(), TimeSource::kGnss);
}

TEST(SensorTime, ComesFromTheHostWhereThereIsNoGnssAndSaysSo) {
  LidarDriver driver = MakeDriver(Vlp32c(), 120.0, 0.5);
  VelodyneSource source;
  for (int i = 0; i < 500; ++i) driver.Add({source.Next(), kNow, {}});
  EXPECT_FALSE(driver.utime());
  while (!driver.utime()) driver.Add({source.Next(), kNow, {}});
  EXPECT_EQ(driver.utime(), kNow);
  EXPECT_EQ(driver.time_source(), TimeSource::kHost);
  const int64_t anchored = *driver.utime();
  driver.Add({source.Next(), kNow + 3'600'000'000, {}});  // the host's clock jumps (FAULTS 19)
  EXPECT_NEAR(static_cast<double>(*driver.utime() - anchored), 12 * 55.296, 1.0);
}

TEST(RmcSentence, IsRefusedUnlessItIsWhole) {
  EXPECT_EQ(ParseRmcTime("$GPRMC,081802.00,A,3649.7478558,N,00224.4542928,W,0.034,212.5,210116,0.0,"
                         "E,A*2E\r\n"),
            1'453'364'282'000'000);
  EXPECT_FALSE(
      ParseRmcTime("$GPRMC,081802.00,A,3649.7478558,N,00224.4542928,W,0.034,212.5,210116,"
                   "0.0,E,A*2F"));
  EXPECT_FALSE(ParseRmcTime("$GPRMC,0818"));
  EXPECT_FALSE(ParseRmcTime(""));
  EXPECT_FALSE(ParseRmcTime("$*00"));
}

TEST(VelodyneDecoder, LetsTimeGoOnOverAJumpOfASensorThatIsSetToAPartOfTheCircle) {
  const VelodyneDecoder decoder(Vlp32c());
  VelodyneSource source;
  Bytes packet = source.Next();
  for (size_t block = 6; block < 12; ++block)
    Put(packet, 100 * block + 2, static_cast<uint64_t>(18000 + 20 * block), 2);
  DecodedPacket decoded;
  ASSERT_FALSE(decoder.Decode(packet, decoded));
  EXPECT_NEAR(decoded.columns[5].time, 5 * 55.296e-6, 1e-7);
  EXPECT_NEAR(decoded.columns[6].time, 0.05, 0.001);
  EXPECT_NEAR(decoded.column_turn, 19.9, 0.2);
}

TEST(VelodyneDecoder, RefusesParametersThatCannotBe) {
  VelodyneParams params = Vlp32c();
  params.model = "HDL-32E";
  EXPECT_THROW(VelodyneDecoder{params}, std::invalid_argument);
  params = Vlp32c();
  params.calibration.elevation.pop_back();
  EXPECT_THROW(VelodyneDecoder{params}, std::invalid_argument);
  params = Vlp32c();
  params.max_range = params.min_range;
  EXPECT_THROW(VelodyneDecoder{params}, std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
