// The race line on real layouts and on random ones.
#include "tools/line/line_study.hpp"

#include <gtest/gtest.h>

#include "common/config.hpp"
#include "daemons/global_mapper/global_mapper_node.hpp"
#include "tests/support/race_run.hpp"
#include "tools/simulator/track_generator.hpp"

namespace hairpin {
namespace {

const RaceLineParams& Params() {
  static const RaceLineParams params =
      LoadGlobalMapperConfig(
          Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "global_mapper"))
          .race_line;
  return params;
}

void ExpectAGoodLine(const LineStudy& study) {
  EXPECT_LT(study.race_squared_curvature, study.middle_squared_curvature);
  EXPECT_LT(study.race.lap_time, study.middle.lap_time);
  const double body = 0.5 * Params().car.body_width + Params().corridor.clearance;
  for (const RaceLine::Point& point : study.race.points) {
    EXPECT_GE(std::min(point.left, point.right), body - 0.1);
    for (const MappedCone& cone : study.input.cones)
      EXPECT_GE((cone.position - point.position).norm(), body - 0.1);
  }
}

class RealLayout : public testing::TestWithParam<const char*> {};

TEST_P(RealLayout, HasALineThatKeepsItsMarginsAndIsFasterThanTheMiddle) {
  const auto file = DataFolder() / "tracks" / (std::string(GetParam()) + ".yaml");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  ExpectAGoodLine(StudyLine(LoadLineInput(file.string()), Params()));
}

INSTANTIATE_TEST_SUITE_P(Layouts, RealLayout,
                         testing::Values("FSG19", "FSG21", "FSE22", "FSO20", "FSS19", "FSS22_V1",
                                         "fssim_FSG"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(RandomLayout, HasALineThatKeepsItsMarginsAndIsFasterThanTheMiddle) {
  const TemporaryFolder folder;
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    GeneratorOptions options;
    options.seed = seed;
    SaveTrack(GenerateTrack(options), folder.File("track.yaml"));
    ExpectAGoodLine(StudyLine(LoadLineInput(folder.File("track.yaml")), Params()));
  }
}

TEST(LoadLineInput, RefusesATrackThatIsNoLap) {
  const std::string strip = std::string(HAIRPIN_SOURCE_DIR) + "/tests/fixtures/tracks/";
  EXPECT_THROW(LoadLineInput(strip + "strip_pacsim.yaml"), std::invalid_argument);
  EXPECT_THROW(LoadLineInput(strip + "absent.yaml"), std::runtime_error);
}

TEST(DrawLine, ShowsEveryCone) {
  const LineStudy study = StudyLine(LoadLineInput(DefaultTrackFile()), Params());
  const std::string picture = DrawLine(study);
  size_t circles = 0;
  for (size_t at = picture.find("<circle"); at != std::string::npos;
       at = picture.find("<circle", at + 1))
    ++circles;
  EXPECT_EQ(circles, study.input.cones.size());
}

}  // namespace
}  // namespace hairpin
