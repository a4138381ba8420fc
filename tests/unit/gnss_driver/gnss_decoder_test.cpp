#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "daemons/gnss_driver/gnss_driver.hpp"
#include "tests/unit/gnss_driver/receiver_messages.hpp"

namespace hairpin {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr GnssErrorModel kErrors{.single_m = 2.5,
                                 .differential_m = 1.0,
                                 .float_m = 0.3,
                                 .rtk_m = 0.015,
                                 .vertical_factor = 1.5,
                                 .velocity_mps = 0.05,
                                 .heading_rad = 0.005};
constexpr const char* kNovatelLog = "NovAtel binary log: have the receiver send NMEA";
// 2026-11-24 12:35:19.2 UTC
constexpr int64_t kUtime = 1'795'523'719'200'000;

std::vector<GnssFix> Decode(GnssDecoder& decoder, const std::string& text) {
  return decoder.Add(Bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

std::string Epoch(const std::string& time) {
  return NmeaFrame("GPGGA," + time + ",4723.7664,N,00838.8878,E,4,12,0.8,440.1,M,47.9,M,1.0,0000") +
         NmeaFrame("GPRMC," + time + ",A,4723.7664,N,00838.8878,E,19.438,90.0,241126,,,R") +
         NmeaFrame("GPGST," + time + ",0.02,0.02,0.01,10.0,0.012,0.011,0.025") +
         NmeaFrame("GPHDT,88.5,T");
}

TEST(GnssDecoder, UnderstandsAnEpochOfNmea) {
  GnssDecoder decoder(kErrors);
  EXPECT_TRUE(Decode(decoder, Epoch("123519.20")).empty()) << "nobody knows yet what belongs to it";
  const std::optional<GnssFix> fix = decoder.Flush();
  ASSERT_TRUE(fix);
  EXPECT_EQ(fix->utime, kUtime);
  EXPECT_EQ(fix->type, FixType::kRtk);
  EXPECT_NEAR(fix->position.latitude_deg, 47.0 + 23.7664 / 60.0, 1e-12);
  EXPECT_NEAR(fix->position.longitude_deg, 8.0 + 38.8878 / 60.0, 1e-12);
  EXPECT_NEAR(fix->position.height_m, 488.0, 1e-9) << "above the ellipsoid, not the sea";
  EXPECT_TRUE(fix->position_sigma.isApprox(Eigen::Vector3d(0.011, 0.012, 0.025)));
  EXPECT_NEAR(fix->velocity.x(), 10.0, 1e-3) << "east";
  EXPECT_NEAR(fix->velocity.y(), 0.0, 1e-9);
  ASSERT_TRUE(fix->heading);
  EXPECT_NEAR(*fix->heading, 1.5 * kDegree, 1e-12) << "counter-clockwise from east";
}

TEST(GnssDecoder, WaitsForNoMoreThanTheEpochBeforeHad) {
  GnssDecoder decoder(kErrors);
  Decode(decoder, Epoch("123519.20"));
  const std::vector<GnssFix> fixes = Decode(decoder, Epoch("123519.30"));
  ASSERT_EQ(fixes.size(), 2U) << "the first by the second's beginning, the second as it is whole";
  EXPECT_EQ(fixes[1].utime, kUtime + 100'000);
  EXPECT_TRUE(fixes[1].heading);
}

TEST(GnssDecoder, DoesNotCareHowTheBytesAreCut) {
  std::string stream = Epoch("123519.20") + "rubbish \xb5 $ \r\n" + Epoch("123519.30");
  GnssDecoder whole(kErrors);
  const size_t expected = Decode(whole, stream).size();
  GnssDecoder cut(kErrors);
  size_t count = 0;
  for (const char c : stream) count += Decode(cut, std::string(1, c)).size();
  EXPECT_EQ(count, expected);
  EXPECT_EQ(expected, 2U);
  EXPECT_EQ(cut.bad(), whole.bad());
}

TEST(GnssDecoder, GoesOverMidnightBeforeTheDateDoes) {
  GnssDecoder decoder(kErrors);
  const std::string position = ",4723.7664,N,00838.8878,E,1,12,0.8,440.1,M,47.9,M,,";
  Decode(decoder, NmeaFrame("GNGGA,235959.90" + position) +
                      NmeaFrame("GNRMC,235959.90,A,,,,,0.0,,311226,,,A"));
  Decode(decoder, NmeaFrame("GNGGA,000000.00" + position));
  const std::optional<GnssFix> fix = decoder.Flush();
  ASSERT_TRUE(fix);
  EXPECT_EQ(fix->utime, 1'798'761'600'000'000) << "2027-01-01 00:00:00";
}

TEST(GnssDecoder, UnderstandsUbxWithTheHeadingOfTwoAntennas) {
  GnssDecoder decoder(kErrors);
  PvtFields pvt;
  pvt.flags = 0x83;  // carrier phase fixed
  std::vector<GnssFix> fixes;
  for (int i = 0; i < 2; ++i) {
    pvt.time_of_week_ms += 100;
    pvt.nano += 100'000'000;
    for (const std::vector<uint8_t>& frame :
         {UbxFrame(kUbxNavPvt, PvtPayload(pvt)),
          UbxFrame(kUbxNavRelPosNed, RelPosNedPayload(pvt.time_of_week_ms, 88.5, 0.25))}) {
      for (const GnssFix& fix : decoder.Add(frame)) fixes.push_back(fix);
    }
  }
  ASSERT_EQ(fixes.size(), 2U);
  const GnssFix& fix = fixes[1];
  EXPECT_EQ(fix.utime, kUtime);
  EXPECT_EQ(fix.type, FixType::kRtk);
  EXPECT_NEAR(fix.position.latitude_deg, 47.3961067, 1e-9);
  EXPECT_NEAR(fix.position.height_m, 488.0, 1e-9);
  EXPECT_TRUE(fix.velocity.isApprox(Eigen::Vector3d(10.0, -2.0, 0.5)));
  EXPECT_NEAR(*fix.heading, 1.5 * kDegree, 1e-9);
  EXPECT_NEAR(fix.heading_sigma, 0.25 * kDegree, 1e-9);
}

TEST(GnssDecoder, CountsWhatIsWrongByReason) {
  GnssDecoder decoder(kErrors);
  Decode(decoder, "$GPHDT,88.6,T*7F\r\n");
  Decode(decoder, "$GPHDT,88.5,T\r\n");
  Decode(decoder, NmeaFrame("GPGGA,129999.00,4723.7664,N,00838.8878,E,4,12,0.8,440.1,M,47.9,M,,"));
  Decode(decoder, NmeaFrame("GPGGA,123519.00,9923.7664,N,00838.8878,E,4,12,0.8,440.1,M,47.9,M,,"));
  Decode(decoder, NmeaFrame("GPHDT,nan,T"));
  Decode(decoder, NmeaFrame("GPHDT,8x8,T"));
  Decode(decoder, "$" + std::string(200, 'x'));
  std::vector<uint8_t> frame = UbxFrame(kUbxNavPvt, PvtPayload({}));
  frame.back() ^= 1;
  decoder.Add(frame);
  decoder.Add(UbxFrame(kUbxNavPvt, std::vector<uint8_t>(10)));
  for (const char* why :
       {"NMEA checksum wrong", "NMEA sentence without checksum", "NMEA time out of range",
        "NMEA position out of range", "NMEA field is no number", "NMEA field out of range",
        "NMEA sentence too long", "UBX checksum wrong", "UBX NAV-PVT of wrong length"}) {
    EXPECT_EQ(decoder.bad().count(why), 1U) << why;
  }
}

TEST(GnssDecoder, RefusesATimeThatDoesNotIncrease) {
  GnssDecoder decoder(kErrors);
  Decode(decoder, Epoch("123519.20") + Epoch("123519.30") + Epoch("123519.10"));
  EXPECT_FALSE(decoder.Flush());
  EXPECT_EQ(decoder.bad().count("time does not increase"), 1U);
}

std::string Recording(const std::string& name) {
  const char* folder = std::getenv("HAIRPIN_DATA");
  return (folder ? std::string(folder) : std::string(HAIRPIN_SOURCE_DIR "/../shared/data")) +
         "/gnss/" + name;
}

struct OraclePosition {
  double latitude_deg;
  double longitude_deg;
  double speed;
};

/// What gpsd makes of a file, by its time stamp to the second.
std::map<std::string, OraclePosition> GpsdPositions(const std::string& file) {
  std::map<std::string, OraclePosition> positions;
  FILE* pipe = popen(("gpsdecode < '" + file + "' 2>/dev/null").c_str(), "r");
  char* line = nullptr;
  size_t capacity = 0;
  while (pipe && getline(&line, &capacity, pipe) > 0) {
    const auto report = nlohmann::json::parse(line, nullptr, false);
    if (report.is_discarded() || report.value("class", "") != "TPV") continue;
    if (!report.contains("lat") || !report.contains("time") || !report.contains("speed")) continue;
    positions[report["time"]] = {report["lat"], report["lon"], report["speed"]};
  }
  std::free(line);
  if (pipe) pclose(pipe);
  return positions;
}

std::string IsoTime(int64_t utime) {
  const std::time_t seconds = utime / 1'000'000;
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[100];
  std::snprintf(text, sizeof(text), "%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", parts.tm_year + 1900,
                parts.tm_mon + 1, parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec,
                static_cast<int>(utime / 1000 % 1000));
  return text;
}

class RealReceiver : public testing::TestWithParam<const char*> {};

TEST_P(RealReceiver, IsUnderstoodAsGpsdUnderstandsIt) {
  const std::string file = Recording(GetParam());
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  if (std::system("command -v gpsdecode > /dev/null") != 0) GTEST_SKIP() << "no gpsdecode here";
  const std::map<std::string, OraclePosition> oracle = GpsdPositions(file);
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  GnssDecoder decoder(kErrors);
  std::vector<GnssFix> fixes = Decode(decoder, bytes);
  if (const std::optional<GnssFix> last = decoder.Flush()) fixes.push_back(*last);
  size_t compared = 0;
  for (const GnssFix& fix : fixes) {
    const auto found = oracle.find(IsoTime(fix.utime));
    if (found == oracle.end() || !fix.has_velocity) continue;
    ++compared;
    EXPECT_NEAR(fix.position.latitude_deg, found->second.latitude_deg, 1e-8);
    EXPECT_NEAR(fix.position.longitude_deg, found->second.longitude_deg, 1e-8);
    EXPECT_NEAR(fix.velocity.head<2>().norm(), found->second.speed, 0.01);
  }
  RecordProperty("compared", static_cast<int>(compared));
  EXPECT_GE(compared, oracle.size() * 9 / 10) << "of " << oracle.size();
  EXPECT_GT(compared, 0U);
}

class NovatelReceiver : public testing::TestWithParam<std::pair<const char*, int>> {};

TEST_P(NovatelReceiver, IsRefusedByNameAndItsLogsAreCounted) {
  const std::string file = Recording(std::string("novatel_oem7/") + GetParam().first);
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  GnssDecoder decoder(kErrors);
  EXPECT_TRUE(Decode(decoder, bytes).empty());
  EXPECT_FALSE(decoder.Flush());
  ASSERT_EQ(decoder.bad().count(kNovatelLog), 1U);
  EXPECT_EQ(decoder.bad().at(kNovatelLog), GetParam().second);
  EXPECT_EQ(decoder.bad().size(), 1U) << "nothing in a log is taken for another protocol";
}

INSTANTIATE_TEST_SUITE_P(Gnss, NovatelReceiver,
                         testing::Values(std::pair("align.gps", 12), std::pair("bestpos.gps", 26),
                                         std::pair("ins1.gps", 284), std::pair("ins2.gps", 835)));

TEST(GnssDecoder, UnderstandsNmeaBetweenNovatelLogs) {
  std::string log("\xaa\x44\x13\x02\xfc\x01\x56\x08\xf0\xc7\x33\x1e$G", 14);
  const uint32_t sum =
      NovatelChecksum(Bytes(reinterpret_cast<const uint8_t*>(log.data()), log.size()));
  for (int i = 0; i < 4; ++i) log += static_cast<char>(sum >> (8 * i) & 0xffU);
  GnssDecoder decoder(kErrors);
  const std::string bytes = log + Epoch("123519.20") + log + Epoch("123519.30") + "\xaa\x44" + log;
  EXPECT_EQ(Decode(decoder, bytes).size(), 2U);
  EXPECT_EQ(decoder.bad().at(kNovatelLog), 3);
  log.back() = static_cast<char>(log.back() ^ 1);
  Decode(decoder, log);
  EXPECT_EQ(decoder.bad().count("NovAtel checksum wrong"), 1U);
}

INSTANTIATE_TEST_SUITE_P(Gnss, RealReceiver,
                         testing::Values("nmea_drive/new.ubx",
                                         "nmea_drive/esempio_tracciato_esterno.ubx",
                                         "pyubx2/pygpsdata-MIXED.log"));

}  // namespace
}  // namespace hairpin
