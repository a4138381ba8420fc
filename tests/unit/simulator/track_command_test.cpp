#include "tools/simulator/track_command.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/unit/simulator/track_testing.hpp"

namespace hairpin {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Outcome {
  int code;
  std::string out;
  std::string err;
};

Outcome Command(std::vector<std::string> words) {
  std::vector<const char*> argv{"hairpin-track"};
  for (const std::string& word : words) argv.push_back(word.c_str());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const int code = RunTrackCommand(static_cast<int>(argv.size()), argv.data());
  const std::string out = ::testing::internal::GetCapturedStdout();
  return {code, out, ::testing::internal::GetCapturedStderr()};
}

TEST(TrackCommand, GenerateMakesTheStraightOfAnEvent) {
  const TemporaryFile file(".yaml");
  const Outcome outcome = Command({"generate", "--event", "acceleration", "--out", file.path()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(LoadTrack(file.path()).name, "acceleration");
  EXPECT_EQ(Command({"generate", "--event", "skidpad", "--out", file.path()}).code, 2);
}

TEST(TrackCommand, GenerateWritesATrackAndDescribesItAsJson) {
  const TemporaryFile file(".yaml");
  const Outcome outcome = Command({"generate", "--seed", "3", "--clutter", "5", "--name", "mine",
                                   "--out", file.path(), "--json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto told = nlohmann::json::parse(outcome.out);
  const Track track = LoadTrack(file.path());
  EXPECT_EQ(track.name, "mine");
  EXPECT_EQ(track.clutter.size(), 5u);
  EXPECT_EQ(told.at("cones").at("left"), track.left.size());
  EXPECT_TRUE(told.at("rule_violations").empty());
}

TEST(TrackCommand, CheckTellsFormatLengthConesAndRules) {
  const Outcome outcome = Command({"check", Fixture("oval_eufs.csv")});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("EUFS CSV, lap of 90 m, cones: 24 left, 30 right"));
  EXPECT_THAT(outcome.out, HasSubstr("shorter than 200 m"));
}

TEST(TrackCommand, CheckGoesOnAfterARefusedFileAndExitsWithBadInput) {
  const Outcome outcome =
      Command({"check", "/nonexistent.yaml", Fixture("oval_fssim.yaml"), "--json"});
  EXPECT_EQ(outcome.code, 78);
  EXPECT_THAT(outcome.err, StartsWith("/nonexistent.yaml:1: cannot be read"));
  const auto tracks = nlohmann::json::parse(outcome.out).at("tracks");
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_TRUE(tracks[0].contains("refused"));
  EXPECT_EQ(tracks[1].at("format"), "FSSIM YAML");
}

TEST(TrackCommand, DrawWritesEveryConeAsACircle) {
  const TemporaryFile file(".svg");
  EXPECT_EQ(Command({"draw", Fixture("oval_pacsim.yaml"), "--out", file.path()}).code, 0);
  const std::string svg = TextOf(file.path());
  EXPECT_THAT(svg, StartsWith("<svg"));
  EXPECT_THAT(svg, HasSubstr("oval_pacsim: lap of 90 m"));
  size_t circles = 0;
  for (size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++circles;
  EXPECT_EQ(circles, 24u + 30u + 1u);
}

TEST(TrackCommand, ConvertKeepsTheTrack) {
  const TemporaryFile file(".yaml");
  EXPECT_EQ(Command({"convert", Fixture("oval_eufs.csv"), file.path()}).code, 0);
  ExpectEqual(LoadTrack(file.path()), LoadTrack(Fixture("oval_eufs.csv")));
}

TEST(TrackCommand, WrongUsageAndFailuresHaveTheirOwnExitCodes) {
  EXPECT_EQ(Command({}).code, 2);
  EXPECT_EQ(Command({"paint"}).code, 2);
  EXPECT_EQ(Command({"generate", "--seed", "1", "--length", "20", "--out", "/tmp/x"}).code, 2);
  EXPECT_EQ(Command({"--help"}).code, 0);
  EXPECT_EQ(Command({"draw", "/nonexistent.yaml", "--out", "/tmp/x.svg"}).code, 78);
  EXPECT_EQ(Command({"draw", Fixture("oval_eufs.csv"), "--out", "/nonexistent/x.svg"}).code, 1);
}

}  // namespace
}  // namespace hairpin
