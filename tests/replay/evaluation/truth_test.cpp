// The car's own receiver as truth, end to end: a simulated lap, the receiver's recording of it, the
// tool, and the figures of both truths side by side.
#include <gmock/gmock.h>
#include <poll.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemons/gnss_driver/gnss_driver_process.hpp"
#include "tests/support/race_run.hpp"
#include "tests/support/synthetic_run.hpp"
#include "tools/evaluation/truth_log.hpp"
#include "tools/report/log_reader.hpp"
#include "tools/report/run_metrics.hpp"
#include "tools/report/trajectory.hpp"
#include "tools/simulator/gnss_receiver.hpp"
#include "tools/simulator/pseudo_terminal.hpp"

namespace hairpin {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const GeodeticPoint kOrigin{47.1234567, 8.573, 150.0};
constexpr double kPositionNoise = 0.01;  // m
constexpr double kHeadingNoise = 0.0052;

/// A lap on the default track, with an RTK receiver on board; driven once for all tests.
const RaceRun& Lap() {
  static const RaceRun run = RunInProcess(
      DefaultTrackFile(), 1, {"gnss off at 12 s for 2 s"},
      {"simulator.motion_sensors.gnss.fix=rtk", "simulator.motion_sensors.gnss.position_bias_m=0",
       "simulator.motion_sensors.gnss.position_noise_m=0.01"});
  return run;
}

std::vector<LogEvent> EventsWithoutTruth(const std::string& file) {
  LogReader reader(file);
  std::vector<LogEvent> events;
  while (auto event = reader.Next()) {
    if (!event->channel.starts_with("TRUTH")) events.push_back(*event);
  }
  return events;
}

class TruthTool : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(log_, std::ios::binary) << Lap().bytes;
    Track track = LoadTrack(DefaultTrackFile());
    track.origin = kOrigin;
    SaveTrack(track, track_);
  }

  /// The receiver's port during the lap, as its own recording would hold it.
  std::string Record(
      GnssProtocol protocol, const std::function<void(gnss_t&)>& change = [](gnss_t&) {}) const {
    const GnssReceiver receiver({protocol, kOrigin});
    std::string file = folder_.File("receiver.raw");
    std::ofstream stream(file, std::ios::binary);
    for (gnss_t measured : Lap().log.gnss) {
      change(measured);
      const std::vector<uint8_t> bytes = receiver.Epoch(measured);
      stream.write(reinterpret_cast<const char*>(bytes.data()),
                   static_cast<std::streamsize>(bytes.size()));
    }
    return file;
  }

  struct Answer {
    int code = -1;
    std::string out;
    std::string error;
  };
  Answer Run(const std::string& arguments) const {
    const std::string errors = folder_.File("stderr");
    const std::string command =
        std::string(HAIRPIN_BINARY_DIR "/bin/hairpin-evaluate ") + arguments + " 2>" + errors;
    Answer answer;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return answer;
    char buffer[4096];
    for (size_t size = 0; (size = fread(buffer, 1, sizeof(buffer), pipe)) > 0;)
      answer.out.append(buffer, size);
    answer.code = WEXITSTATUS(pclose(pipe));
    std::ostringstream text;
    text << std::ifstream(errors).rdbuf();
    answer.error = text.str();
    return answer;
  }
  Answer MakeTruth(const std::string& more) const {
    return Run("truth --json --config-dir " HAIRPIN_SOURCE_DIR "/config --log " + log_ +
               " --track " + track_ + " --out " + true_log_ + " " + more);
  }

  /// The receiver's truth is the simulator's but for the receiver's noise.
  static void ExpectNear(const json& deviation) {
    EXPECT_LT(deviation["position_rms_m"], 1.2 * std::sqrt(2.0) * kPositionNoise);
    EXPECT_LT(deviation["position_max_m"], 0.06);
    EXPECT_NEAR(deviation["yaw_rms_rad"], kHeadingNoise, 0.1 * kHeadingNoise);
  }
  /// The way driven, before the gap and after it: through it only the straight line is known.
  static void ExpectSameWay(const RunLog& log) {
    const TrueTrajectory simulated(Lap().log);
    const auto after_gap = std::adjacent_find(
        log.truth.begin(), log.truth.end(),
        [](const truth_t& a, const truth_t& b) { return b.utime - a.utime > 500'000; });
    ASSERT_NE(after_gap, log.truth.end());
    const auto near = [&](const truth_t& from, const truth_t& to) {
      EXPECT_NEAR(to.distance_m - from.distance_m,
                  simulated.At(to.utime)->distance - simulated.At(from.utime)->distance, 1.0);
    };
    near(log.truth.front(), *after_gap);
    near(*(after_gap + 1), log.truth.back());
    EXPECT_LT(log.truth.back().distance_m, Lap().log.truth.back().distance_m);
  }
  /// So are the figures of the whole report.
  void ExpectSameFigures() const {
    const RunLog log = LoadRunLog(true_log_);
    const json simulated = EvaluateRun(Lap().log, {});
    const json received = EvaluateRun(log, {});
    for (const char* key : {"matched", "missed", "false", "doubled"})
      EXPECT_EQ(received["map"][key], simulated["map"][key]) << key;
    for (const char* map : {"map", "local_map"}) {
      for (const char* key : {"rmse_m", "worst_m"})
        EXPECT_NEAR(received[map][key], simulated[map][key], 0.005) << map << ' ' << key;
    }
    EXPECT_NEAR(received["velocity"]["vx_rms_mps"], simulated["velocity"]["vx_rms_mps"], 0.06);
    EXPECT_EQ(received["log"]["undecodable"], 0);
    EXPECT_EQ(log.truth.back().lap, Lap().log.truth.back().lap);
    ExpectSameWay(log);
  }

  const TemporaryFolder folder_;
  std::string log_ = folder_.File("log.lcmlog");
  std::string track_ = folder_.File("track.yaml");
  std::string true_log_ = folder_.File("true.lcmlog");
};

class TruthByProtocol : public TruthTool, public testing::WithParamInterface<GnssProtocol> {};

TEST_P(TruthByProtocol, IsThatOfTheSimulatorWithinTheReceiversNoise) {
  const Answer answer = MakeTruth("--replace --receiver " + Record(GetParam()));
  ASSERT_EQ(answer.code, 0) << answer.error;
  const json figures = json::parse(answer.out);
  ExpectNear(figures["deviation"]);
  EXPECT_EQ(figures["truths"], figures["fixes"]);
  ASSERT_EQ(figures["gaps"].size(), 1u);
  EXPECT_NEAR(figures["gaps"][0]["duration_s"], 2.0, 0.15);
  ExpectSameFigures();

  const std::vector<LogEvent> before = EventsWithoutTruth(log_);
  const std::vector<LogEvent> after = EventsWithoutTruth(true_log_);
  ASSERT_EQ(after.size(), before.size());
  for (size_t i = 0; i < before.size(); ++i) {
    ASSERT_EQ(after[i].timestamp_us, before[i].timestamp_us);
    ASSERT_EQ(after[i].channel, before[i].channel);
    ASSERT_EQ(after[i].data, before[i].data);
  }
}

INSTANTIATE_TEST_SUITE_P(Protocols, TruthByProtocol,
                         testing::Values(GnssProtocol::kUbx, GnssProtocol::kNmea),
                         [](const auto& instance) {
                           return instance.param == GnssProtocol::kUbx ? "Ubx" : "Nmea";
                         });

TEST_F(TruthTool, ReadsTheGnssOfTheRunWhereItsOriginIsKnown) {
  const Answer refused = MakeTruth("--replace");
  EXPECT_EQ(refused.code, 78);
  EXPECT_THAT(refused.error, HasSubstr("origin.is_first_fix"));
  const Answer answer = MakeTruth(
      "--replace --set origin.is_first_fix=false --set origin.latitude_deg=47.1234567 "
      "--set origin.longitude_deg=8.573 --set origin.height_m=150");
  ASSERT_EQ(answer.code, 0) << answer.error;
  ExpectNear(json::parse(answer.out)["deviation"]);
  ExpectSameFigures();
}

TEST_F(TruthTool, MapSaysOfItsLogWhatItSaysOfTheSimulators) {
  ASSERT_EQ(MakeTruth("--replace --receiver " + Record(GnssProtocol::kUbx)).code, 0);
  const json simulated = json::parse(Run("map --json --log " + log_).out);
  const json received = json::parse(Run("map --json --log " + true_log_).out);
  EXPECT_NEAR(received["rmse_m"], simulated["rmse_m"], 0.005);
  EXPECT_EQ(received["matched"], simulated["matched"]);
  EXPECT_EQ(received["error_along_track"].size(), simulated["error_along_track"].size());
}

TEST_F(TruthTool, ARecordingSaysWhatTheDriverHeardOnItsPort) {
  const std::string file = Record(GnssProtocol::kUbx);
  GnssDriverParams params =
      LoadGnssDriverParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "gnss_driver"));
  params.origin_is_first_fix = false;
  params.origin = kOrigin;
  PseudoTerminal port;
  params.port = port.path();
  Transport transport("memq://");
  Bus bus(transport, "gnss_driver", 1);
  Bus listener(transport, "test", 2);
  std::vector<gnss_t> heard;
  listener.Subscribe(channels::kGnss, [&heard](const gnss_t& fix) { heard.push_back(fix); });
  ManualClock clock;
  GnssDriverProcess driver(params, bus, clock);
  const ReceiverRecording recording = ReadReceiver(file, params, kOrigin);
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> said{std::istreambuf_iterator<char>(stream), {}};
  Bytes left(reinterpret_cast<const uint8_t*>(said.data()), said.size());
  // A terminal takes what it has room for, and hands it on a little later.
  pollfd waiting{driver.descriptors().at(0), POLLIN, 0};
  while (heard.size() < recording.fixes.size()) {
    left = left.subspan(port.Write(left.first(std::min<size_t>(left.size(), 500))));
    ASSERT_GT(poll(&waiting, 1, 30'000), 0) << heard.size() << " fixes so far";
    driver.Poll();
    transport.Drain();
  }
  ASSERT_EQ(heard.size(), recording.fixes.size());
  ASSERT_GT(heard.size(), 400u);
  for (size_t i = 0; i < heard.size(); ++i) {
    gnss_t expected = recording.fixes[i];
    expected.boot_id = heard[i].boot_id;
    expected.sequence = heard[i].sequence;
    ASSERT_EQ(Encoded(heard[i]), Encoded(expected)) << i;
  }
}

TEST_F(TruthTool, SaysWhatIsMissingAndWritesNoLog) {
  const std::string receiver = Record(GnssProtocol::kUbx);
  EXPECT_THAT(MakeTruth("--receiver " + receiver).error, HasSubstr("holds TRUTH already"));
  const std::string all = "--replace --receiver ";
  const auto refused = [this, &all](const std::string& file, const std::string& why) {
    const Answer answer = MakeTruth(all + file);
    EXPECT_EQ(answer.code, 78);
    EXPECT_THAT(answer.error, HasSubstr(why));
  };
  refused(folder_.File("nowhere"), "cannot be read");
  refused(track_, "holds no fix of a receiver");
  refused(Record(GnssProtocol::kUbx, [](gnss_t& fix) { fix.fix = gnss_t::FIX_FLOAT; }),
          "no fixed RTK solution (fixes: ");
  refused(Record(GnssProtocol::kNmea, [](gnss_t& fix) { fix.heading_valid = 0; }),
          "no fixed RTK solution with a heading");
  refused(Record(GnssProtocol::kUbx, [](gnss_t& fix) { fix.utime += 86'400'000'000; }),
          "lies within the time of");
  SaveTrack(LoadTrack(DefaultTrackFile()), track_);
  refused(Record(GnssProtocol::kUbx), "origin: is missing");
  EXPECT_FALSE(std::filesystem::exists(true_log_));
  EXPECT_EQ(Run("truth --log " + log_ + " --out " + log_ + " --track " + track_).code, 2);
  EXPECT_EQ(Run("truth --log " + log_).code, 2);
  EXPECT_EQ(Run("truth --help").code, 0);
}

}  // namespace
}  // namespace hairpin
