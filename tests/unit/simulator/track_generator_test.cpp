#include "tools/simulator/track_generator.hpp"

#include <gmock/gmock.h>

#include "tests/unit/simulator/track_testing.hpp"
#include "tools/simulator/track_checks.hpp"

namespace hairpin {
namespace {

using ::testing::IsEmpty;

TEST(TrackGenerator, TracksOfTwoHundredSeedsAreLegal) {
  constexpr uint64_t kSeeds = 200;
  double shortest = 1e9;
  double longest = 0.0;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Track track = GenerateTrack({seed, std::nullopt, 0});
    ASSERT_FALSE(FindProblem(track).has_value()) << "seed " << seed;
    ASSERT_THAT(CheckRules(track), IsEmpty()) << "seed " << seed;
    ExpectSidesBeginAtTheLine(track);
    const double length = Length(CentreLine(track), false);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  EXPECT_LT(shortest, 270.0);
  EXPECT_GT(longest, 410.0);
}

TEST(TrackGenerator, TheCarWaitsAtTheOriginSixMetresBeforeTheGate) {
  const Track track = GenerateTrack({7, std::nullopt, 0});
  EXPECT_EQ(track.start.position(), Eigen::Vector2d::Zero());
  EXPECT_DOUBLE_EQ(track.start_line.left.x(), 6.0);
  EXPECT_DOUBLE_EQ(track.start_line.right.x(), 6.0);
  for (const auto* side : {&track.left, &track.right}) {
    EXPECT_EQ(side->front().colour, ConeColour::kOrangeLarge);
    EXPECT_EQ(side->back().colour, ConeColour::kOrangeLarge);
    EXPECT_DOUBLE_EQ(side->front().position.x(), 7.25);
    EXPECT_DOUBLE_EQ(side->back().position.x(), 4.75);
  }
}

TEST(TrackGenerator, TheSameSeedMakesTheSameTrackAndAnotherOneAnother) {
  ExpectEqual(GenerateTrack({11, 320.0, 20}), GenerateTrack({11, 320.0, 20}));
  EXPECT_NE(GenerateTrack({11, 320.0, 0}).left[9].position,
            GenerateTrack({12, 320.0, 0}).left[9].position);
}

TEST(TrackGenerator, TheDefaultTrackIsWhatItsCommandMakes) {
  // The pinned file also catches a machine whose arithmetic makes another track.
  Track track = GenerateTrack({4, 300.0, 0});
  track.name = "default";
  const TemporaryFile file(".yaml");
  SaveTrack(track, file.path());
  EXPECT_EQ(TextOf(file.path()),
            TextOf(std::string(HAIRPIN_SOURCE_DIR) + "/config/tracks/default.yaml"));
}

TEST(AccelerationTrack, IsWhatLiesAmongTheTracks) {
  const TemporaryFile file(".yaml");
  SaveTrack(AccelerationTrack(), file.path());
  EXPECT_EQ(TextOf(file.path()),
            TextOf(std::string(HAIRPIN_SOURCE_DIR) + "/config/tracks/acceleration.yaml"));
}

TEST(AccelerationTrack, IsAStraightOf75MetresThatObeysTheRules) {
  const Track track = AccelerationTrack();
  EXPECT_FALSE(FindProblem(track)) << FindProblem(track)->what;
  EXPECT_TRUE(CheckRules(track).empty()) << CheckRules(track).front();
  EXPECT_NEAR(track.finish_line.left.x() - track.start_line.left.x(), 75.0, 1e-9);
  int large = 0;
  for (const TrackCone& cone : track.left) {
    EXPECT_EQ(cone.position.y(), 1.75);
    large += cone.colour == ConeColour::kOrangeLarge ? 1 : 0;
  }
  EXPECT_EQ(large, 4);
  EXPECT_NEAR(track.left.back().position.x() - track.finish_line.left.x(), 100.0, 1e-9);
}

TEST(TrackGenerator, LapsHaveTheLengthAskedFor) {
  for (const double length : {210.0, 300.0, 495.0}) {
    EXPECT_NEAR(Length(CentreLine(GenerateTrack({3, length, 0})), false), length, 0.02 * length);
  }
}

TEST(TrackGenerator, ClutterStandsBesideTheTrackOnly) {
  const Track plain = GenerateTrack({5, std::nullopt, 0});
  const Track track = GenerateTrack({5, std::nullopt, 40});
  ASSERT_EQ(track.clutter.size(), 40u);
  EXPECT_EQ(PositionsOf(track.left), PositionsOf(plain.left));  // clutter does not change the track
  for (const Eigen::Vector2d& thing : track.clutter) {
    EXPECT_FALSE(IsOnTrack(track, thing));
    const double away = std::min(Nearest(PositionsOf(track.left), true, thing).distance,
                                 Nearest(PositionsOf(track.right), true, thing).distance);
    EXPECT_GE(away, 1.5);
    EXPECT_LE(away, 6.0);
  }
}

TEST(TrackGenerator, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(GenerateTrack({1, 199.0, 0}), std::invalid_argument);
  EXPECT_THROW(GenerateTrack({1, 501.0, 0}), std::invalid_argument);
  EXPECT_THROW(GenerateTrack({1, std::nan(""), 0}), std::invalid_argument);
  EXPECT_THROW(GenerateTrack({1, std::nullopt, -1}), std::invalid_argument);
  EXPECT_THROW(GenerateTrack({1, std::nullopt, 201}), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
