#include "tools/simulator/track_formats.hpp"

#include <gmock/gmock.h>

#include "tests/unit/simulator/track_testing.hpp"

namespace hairpin {
namespace {

using Eigen::Vector2d;
using ::testing::ElementsAre;

std::vector<ConeColour> ColoursOf(const std::vector<TrackCone>& cones) {
  std::vector<ConeColour> colours;
  for (const TrackCone& cone : cones) colours.push_back(cone.colour);
  return colours;
}

TEST(TrackFormats, OwnYamlIsReadAsItStands) {
  const LoadedTrack loaded = LoadTrackOfAnyFormat(Fixture("oval_hairpin.yaml"));
  const Track& track = loaded.track;
  EXPECT_EQ(loaded.format, TrackFormat::kHairpin);
  EXPECT_EQ(track.name, "oval");
  EXPECT_TRUE(track.closed);
  EXPECT_EQ(track.left.size(), 24u);
  EXPECT_EQ(track.right.size(), 30u);
  EXPECT_EQ(track.left[0].position, Vector2d(8.0, 2.0));
  EXPECT_EQ(track.start_line.left, Vector2d(6.0, 2.0));
  EXPECT_EQ(track.finish_line.right, Vector2d(6.0, -2.0));
  EXPECT_THAT(ColoursOf(track.others),
              ElementsAre(ConeColour::kOrangeLarge, ConeColour::kOrangeLarge));
  EXPECT_THAT(track.clutter, ElementsAre(Vector2d(0.0, 8.0)));
}

TEST(TrackFormats, PacsimFssimAndEufsTellTheSameOval) {
  const Track own = LoadTrack(Fixture("oval_hairpin.yaml"));
  for (const std::string name : {"oval_pacsim.yaml", "oval_fssim.yaml", "oval_eufs.csv"}) {
    SCOPED_TRACE(name);
    const Track track = LoadTrack(Fixture(name));
    EXPECT_TRUE(track.closed);
    EXPECT_EQ(track.name, name.substr(0, name.find('.')));
    ExpectSidesBeginAtTheLine(track);
    EXPECT_LT((track.start_line.left - own.start_line.left).norm(), 1e-9);
    EXPECT_LT((track.start_line.right - own.start_line.right).norm(), 1e-9);
    EXPECT_EQ(PositionsOf(track.left), PositionsOf(own.left));
    EXPECT_EQ(PositionsOf(track.right), PositionsOf(own.right));
  }
}

TEST(TrackFormats, PacsimUnknownObjectsAreClutterAndColouredOnesCones) {
  const LoadedTrack loaded = LoadTrackOfAnyFormat(Fixture("oval_pacsim.yaml"));
  EXPECT_EQ(loaded.format, TrackFormat::kPacsim);
  EXPECT_THAT(loaded.track.clutter, ElementsAre(Vector2d(0.0, 8.0)));
  ASSERT_EQ(loaded.track.others.size(), 1u);
  EXPECT_EQ(loaded.track.others[0].colour, ConeColour::kOrangeLarge);
}

TEST(TrackFormats, PacsimOpenTrackHasAFinishAndNoInvisibleCones) {
  const Track track = LoadTrack(Fixture("strip_pacsim.yaml"));
  EXPECT_FALSE(track.closed);
  EXPECT_EQ(track.start_line.left, Vector2d(0.0, 1.9));
  EXPECT_EQ(track.finish_line.right, Vector2d(20.0, -1.9));
  constexpr ConeColour kLarge = ConeColour::kOrangeLarge;
  constexpr ConeColour kBlue = ConeColour::kBlue;
  constexpr ConeColour kOrange = ConeColour::kOrange;
  EXPECT_THAT(ColoursOf(track.left),
              ElementsAre(kLarge, kLarge, kBlue, kBlue, kBlue, kLarge, kLarge, kOrange, kOrange));
  EXPECT_DOUBLE_EQ(track.left[0].position.x(), -0.3);
  EXPECT_DOUBLE_EQ(track.left[6].position.x(), 20.3);
  ASSERT_EQ(track.others.size(), 1u);  // the one in mid-track
}

TEST(TrackFormats, FssimStartsWithItsFrontWingAtThePose) {
  const LoadedTrack loaded = LoadTrackOfAnyFormat(Fixture("oval_fssim.yaml"));
  EXPECT_EQ(loaded.format, TrackFormat::kFssim);
  EXPECT_DOUBLE_EQ(loaded.track.start.x, -1.4);
  EXPECT_EQ(loaded.track.others.size(), 4u);  // large orange cones that stand beside the sides
}

TEST(TrackFormats, FssimDropsTheConeThatClosesTheLoop) {
  const std::string text = TextOf(Fixture("oval_fssim.yaml"));
  ASSERT_NE(text.find("- - -8\n  - 2\n", text.find("- - -8\n  - 2\n") + 1), std::string::npos);
  EXPECT_EQ(LoadTrack(Fixture("oval_fssim.yaml")).left.size(), 24u);
}

TEST(TrackFormats, EufsLargeOrangeConesFillTheGapsOfTheSides) {
  const LoadedTrack loaded = LoadTrackOfAnyFormat(Fixture("oval_eufs.csv"));
  EXPECT_EQ(loaded.format, TrackFormat::kEufs);
  EXPECT_EQ(loaded.track.left.front().colour, ConeColour::kOrangeLarge);
  EXPECT_EQ(loaded.track.left.back().colour, ConeColour::kOrangeLarge);
  EXPECT_EQ(loaded.track.right.front().colour, ConeColour::kOrangeLarge);
  EXPECT_TRUE(loaded.track.others.empty());
}

TEST(TrackFormats, WithoutALineTheGateIsAheadOfTheCar) {
  const std::string text = TextOf(Fixture("oval_eufs.csv"));
  std::string plain = text;
  for (size_t at = 0; (at = plain.find("big_orange")) != std::string::npos;) {
    const bool left = plain[plain.find(',', plain.find(',', at) + 1) + 1] != '-';
    plain.replace(at, std::string("big_orange").size(), left ? "blue" : "yellow");
  }
  const TemporaryFile file(".csv", plain);
  const Track track = LoadTrack(file.path());
  EXPECT_LT((track.start_line.left - Vector2d(2.5, 2.0)).norm(), 1e-9);
  EXPECT_LT((track.left[0].position - Vector2d(4.0, 2.0)).norm(), 1e-9);
}

TEST(TrackFormats, SidesListedAgainstTheDrivingDirectionAreTurnedRound) {
  // The oval the other way round: the car faces back, and what was left is right.
  std::string text = TextOf(Fixture("oval_pacsim.yaml"));
  text =
      Replaced(text, "orientation: [0.0, 0.0, 0.0]", "orientation: [0.0, 0.0, 3.141592653589793]");
  text = Replaced(text, "  left:", "  swapped:");
  text = Replaced(text, "  right:", "  left:");
  text = Replaced(text, "  swapped:", "  right:");
  for (auto [from, to] : {std::pair("class: blue", "class: X"),
                          {"class: yellow", "class: blue"},
                          {"class: X", "class: yellow"}}) {
    while (text.find(from) != std::string::npos) text = Replaced(text, from, to);
  }
  text = Replaced(Replaced(text, "[6.0, -5.0, 0.0]", "[-6.0, -5.0, 0.0]"), "[6.0, 5.0, 0.0]",
                  "[-6.0, 5.0, 0.0]");
  const TemporaryFile file(".yaml", text);
  const Track track = LoadTrack(file.path());
  ExpectSidesBeginAtTheLine(track);
  EXPECT_LT((track.start_line.left - Vector2d(-6.0, -2.0)).norm(), 1e-9);
  EXPECT_EQ(track.left[0].position, Vector2d(-8.0, -2.0));
}

TEST(TrackFormats, SavedTracksAreReadBackExactly) {
  for (const std::string name : {"oval_hairpin.yaml", "oval_pacsim.yaml", "oval_fssim.yaml",
                                 "oval_eufs.csv", "strip_pacsim.yaml"}) {
    SCOPED_TRACE(name);
    Track track = LoadTrack(Fixture(name));
    track.name = "a \"name\" with \\ and: colon # hash";
    track.clutter.emplace_back(1.0 / 3.0, -1e-17);
    const TemporaryFile file(".yaml");
    SaveTrack(track, file.path());
    ExpectEqual(LoadTrack(file.path()), track);
  }
}

TEST(TrackFormats, SavingWhereNothingCanBeWrittenThrows) {
  const Track track = LoadTrack(Fixture("oval_hairpin.yaml"));
  EXPECT_THROW(SaveTrack(track, "/nonexistent/track.yaml"), std::runtime_error);
}

}  // namespace
}  // namespace hairpin
