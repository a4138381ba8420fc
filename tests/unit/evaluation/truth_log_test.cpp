#include "tools/evaluation/truth_log.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "common/geometry.hpp"
#include "tests/support/oval_track.hpp"
#include "tests/support/synthetic_run.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/evaluation/receiver_truth.hpp"
#include "tools/report/log_reader.hpp"
#include "tools/simulator/gnss_receiver.hpp"

namespace hairpin {
namespace {

const GeodeticPoint kOrigin{47.3961, 8.6481, 488.0};

GnssDriverParams Driver() {
  GnssDriverParams params =
      LoadGnssDriverParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "gnss_driver"));
  params.antenna_baseline_yaw = 0.25;
  return params;
}

std::vector<LogEvent> EventsOf(const std::string& file) {
  LogReader reader(file);
  std::vector<LogEvent> events;
  while (auto event = reader.Next()) events.push_back(*event);
  return events;
}

bool IsTruth(const LogEvent& event) { return event.channel.starts_with("TRUTH"); }

TEST(TruthLog, KeepsEveryEventAndPutsTruthWhereItsTimeLies) {
  const TemporaryFolder folder;
  LogWriter writer(folder.File("run.lcmlog"));
  const uint8_t bytes[] = {1, 2, 3};
  const std::vector<int64_t> times{1000, 2000, 1900, 3000};  // as they arrived
  for (const int64_t time : times) writer.Write(time, "SOMETHING", bytes, sizeof(bytes));
  truth_t old{};
  writer.Write(3000, channels::kTruth, old);
  writer.Close();

  std::vector<truth_t> truth(3);
  truth[0].utime = 1000;
  truth[1].utime = 2500;
  truth[2].utime = 3300;
  WriteTruthLog(folder.File("run.lcmlog"), folder.File("true.lcmlog"), OvalTrack(), truth);

  const std::vector<LogEvent> events = EventsOf(folder.File("true.lcmlog"));
  std::vector<std::string> channels;
  std::vector<int64_t> kept;
  for (const LogEvent& event : events) {
    channels.push_back(event.channel);
    if (IsTruth(event)) continue;
    kept.push_back(event.timestamp_us);
    EXPECT_THAT(event.data, testing::ElementsAreArray(bytes));
  }
  EXPECT_EQ(kept, times);
  EXPECT_THAT(channels, testing::ElementsAre("TRUTH_TRACK", "TRUTH", "SOMETHING", "SOMETHING",
                                             "SOMETHING", "TRUTH", "SOMETHING", "TRUTH"));
  const RunLog log = LoadRunLog(folder.File("true.lcmlog"));
  EXPECT_EQ(log.truth.size(), 3u);
  ASSERT_TRUE(log.truth_track);
  EXPECT_EQ(log.truth_track->name, "oval");
  EXPECT_EQ(log.undecodable, 0);
}

TEST(TruthLog, TakesFixesOfTheLogsTimeOnly) {
  RunLog log;
  log.first_us = 10'000'000;
  log.last_us = 20'000'000;
  std::vector<gnss_t> fixes(5);
  const int64_t times[] = {9'400'000, 9'600'000, 15'000'000, 20'400'000, 20'600'000};
  for (size_t i = 0; i < fixes.size(); ++i) fixes[i].utime = times[i];
  const std::vector<gnss_t> during = DuringLog(fixes, log);
  ASSERT_EQ(during.size(), 3u);
  EXPECT_EQ(during.front().utime, 9'600'000);
  EXPECT_EQ(during.back().utime, 20'400'000);
}

TEST(TruthLog, MovesGnssFromTheOriginOfTheDriverToThatOfTheTrack) {
  const LocalEnu map(kOrigin);
  const GeodeticPoint elsewhere = map.ToGeodetic({120.0, -40.0, 3.0});
  std::vector<gnss_t> fixes(1);
  fixes[0].position_enu_m[0] = -120.0;
  fixes[0].position_enu_m[1] = 40.0;
  const gnss_t moved = InMap(fixes, elsewhere, kOrigin).front();
  EXPECT_NEAR(moved.position_enu_m[0], 0.0, 0.01);
  EXPECT_NEAR(moved.position_enu_m[1], 0.0, 0.01);
}

class Recording : public testing::TestWithParam<GnssProtocol> {};

TEST_P(Recording, OfTheReceiverIsReadAsGnssInTheTracksFrameWithTheHeadingOfBase) {
  const TemporaryFolder folder;
  const GnssReceiver receiver({GetParam(), kOrigin});
  std::ofstream stream(folder.File("receiver.raw"), std::ios::binary);
  stream << "\xb5\x62 starts in the middle";
  constexpr int kEpochs = 2000;  // some chunks
  for (int i = 0; i < kEpochs; ++i) {
    gnss_t measured{};
    measured.utime = 1'795'523'719'000'000 + 100'000 * i;
    measured.fix = gnss_t::FIX_RTK;
    measured.position_enu_m[0] = 0.1 * i;
    measured.velocity_enu_mps[0] = 1.0;
    measured.position_sigma_m[0] = measured.position_sigma_m[1] = 0.012;
    measured.heading_valid = 1;
    measured.heading_rad = 1.0;
    const std::vector<uint8_t> bytes = receiver.Epoch(measured);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
  }
  stream.close();
  const ReceiverRecording recording = ReadReceiver(folder.File("receiver.raw"), Driver(), kOrigin);
  ASSERT_EQ(recording.fixes.size(), static_cast<size_t>(kEpochs)) << "the last one too";
  EXPECT_FALSE(recording.bad_frames.empty());
  for (int i = 0; i < kEpochs; ++i) {
    const gnss_t& fix = recording.fixes[static_cast<size_t>(i)];
    EXPECT_EQ(fix.utime, 1'795'523'719'000'000 + 100'000 * i);
    EXPECT_EQ(fix.fix, gnss_t::FIX_RTK);
    EXPECT_NEAR(fix.position_enu_m[0], 0.1 * i, 0.012);
    EXPECT_NEAR(fix.heading_rad, 0.75, 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(Protocols, Recording,
                         testing::Values(GnssProtocol::kUbx, GnssProtocol::kNmea),
                         [](const auto& instance) {
                           return instance.param == GnssProtocol::kUbx ? "Ubx" : "Nmea";
                         });

TEST(RecordingOfARealCar, IsFixedRtkButWithoutASecondAntennaNoTruth) {
  const char* named = std::getenv("HAIRPIN_DATA");
  const std::filesystem::path data =
      named != nullptr ? named : HAIRPIN_SOURCE_DIR "/../shared/data";
  const std::filesystem::path file = data / "gnss/nmea_drive/esempio_tracciato_esterno.ubx";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  const ReceiverRecording recording = ReadReceiver(file, Driver(), kOrigin);
  EXPECT_GT(recording.fixes.size(), 900u);
  const ReceiverTruth result = TruthOfReceiver(
      recording.fixes, OvalTrack(),
      {.antenna = Eigen::Vector2d::Zero(), .max_position_sigma = 0.05, .max_heading_sigma = 0.01});
  EXPECT_TRUE(result.truth.empty());
  EXPECT_GT(result.left_out.at("no_heading"), 850);
  EXPECT_EQ(result.left_out.at("float"), 27);
}

}  // namespace
}  // namespace hairpin
