// Layouts of real competitions, made by others (MIT); not in the repository.
#include <gmock/gmock.h>

#include "tests/unit/simulator/track_testing.hpp"
#include "tools/simulator/track_checks.hpp"
#include "tools/simulator/track_generator.hpp"

namespace hairpin {
namespace {

using ::testing::HasSubstr;

std::string DataFolder() {
  const char* set = std::getenv("HAIRPIN_DATA");
  return (set ? std::string(set) : std::string(HAIRPIN_SOURCE_DIR) + "/../shared/data") +
         "/tracks/";
}

struct Layout {
  const char* file;
  size_t left;
  size_t right;
  size_t others;
  bool closed;
  double length;         // m along the centre line, as told when each was looked at in a picture
  double start_to_line;  // m
};

class RealTrack : public ::testing::TestWithParam<Layout> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(DataFolder() + GetParam().file)) {
      GTEST_SKIP() << DataFolder() + GetParam().file << " is absent";
    }
  }
};

TEST_P(RealTrack, LoadsWithItsConesInDrivingOrder) {
  const Layout& layout = GetParam();
  const Track track = LoadTrack(DataFolder() + layout.file);
  EXPECT_EQ(track.left.size(), layout.left);
  EXPECT_EQ(track.right.size(), layout.right);
  EXPECT_EQ(track.others.size(), layout.others);
  EXPECT_EQ(track.closed, layout.closed);
  ExpectSidesBeginAtTheLine(track);
  const Polyline centre = CentreLine(track);
  EXPECT_NEAR(Length(centre, false), layout.length, 1.0);
  const Eigen::Vector2d middle = 0.5 * (track.start_line.left + track.start_line.right);
  EXPECT_NEAR((track.start.Inverse() * middle).x(), layout.start_to_line, 0.1);
}

TEST_P(RealTrack, GoingAlongItIsProgressFromTheStart) {
  const Track track = LoadTrack(DataFolder() + GetParam().file);
  const Polyline centre = CentreLine(track);
  for (const auto* side : {&track.left, &track.right}) {
    size_t last = 0;
    for (const TrackCone& cone : *side) {
      // A bend of the line may hold a cone's foot back a little, never by more than a cone's
      // spacing.
      const size_t foot = Nearest(centre, false, cone.position).segment;
      EXPECT_GE(foot + 4, last);
      last = std::max(last, foot);
    }
    EXPECT_GT(last, centre.size() * 9 / 10);
  }
}

TEST_P(RealTrack, SurvivesARoundTrip) {
  const Track track = LoadTrack(DataFolder() + GetParam().file);
  const TemporaryFile file(".yaml");
  SaveTrack(track, file.path());
  ExpectEqual(LoadTrack(file.path()), track);
}

INSTANTIATE_TEST_SUITE_P(
    Competitions, RealTrack,
    ::testing::Values(Layout{"FSG19.yaml", 82, 73, 0, true, 302.0, 7.6},
                      Layout{"FSS19.yaml", 86, 80, 0, true, 230.0, 6.1},
                      Layout{"FSO20.yaml", 125, 125, 0, true, 382.0, 6.0},
                      Layout{"FSE22.yaml", 62, 57, 0, true, 154.0, 7.0},
                      Layout{"FSG21.yaml", 74, 60, 0, true, 220.0, 6.7},
                      Layout{"FSS22_V1.yaml", 57, 66, 0, true, 267.0, 8.0},
                      Layout{"fssim_FSG.yaml", 94, 88, 4, true, 308.0, 7.4},
                      Layout{"acceleration.yaml", 33, 33, 1, false, 150.3, 1.98},
                      Layout{"small_track.csv", 37, 40, 0, true, 149.7, 5.3},
                      Layout{"Hairpin_02_03_2023.csv", 23, 12, 0, true, 54.5, 3.9}),
    [](const auto& test) {
      const std::string file = test.param.file;
      return file.substr(0, file.find('.'));
    });

TEST(RealTracks, SkidpadIsRefusedBecauseItCrossesItself) {
  const std::string file = DataFolder() + "skidpad.yaml";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  try {
    LoadTrack(file);
    ADD_FAILURE();
  } catch (const TrackError& error) {
    EXPECT_THAT(error.what(), HasSubstr("skidpad.yaml:17: yellow cone on the left side"));
  }
}

}  // namespace
}  // namespace hairpin
