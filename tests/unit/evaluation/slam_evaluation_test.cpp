#include "tools/evaluation/slam_evaluation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "daemons/global_mapper/global_mapper_node.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/evaluation/recording_error.hpp"

namespace hairpin {
namespace {

std::string Written(const TemporaryFolder& folder, const std::string& text) {
  const std::string file = folder.File("slam.txt");
  std::ofstream(file) << text;
  return file;
}

const char* const kTwoPoses =
    "ODOMETRY 0 1 1 0 0 0.01 0 0 0.01 0 0.01\n"
    "LANDMARK 1 2 3 4 0.4 0 0.4\n"
    "ODOMETRY 1 3 1 0 0 0.01 0 0 0.01 0 0.01\n"
    "LANDMARK 3 2 2 4 0.4 0 0.4\n";

TEST(LoadSlamDataset, ReadsNoiseAsItIsTold) {
  const TemporaryFolder folder;
  const std::string file = Written(folder, kTwoPoses);
  const auto by = [&](NoiseReading reading) {
    return LoadSlamDataset(file, reading).steps[1].sightings[0];
  };
  const auto scale = [](const SlamDataset::Sighting& sighting) {
    return sighting.measurement.sqrt_information(0, 0);
  };
  EXPECT_NEAR(scale(by(NoiseReading::kInformation)), std::sqrt(0.4), 1e-12);
  EXPECT_NEAR(scale(by(NoiseReading::kCovariance)), 1.0 / std::sqrt(0.4), 1e-12);
  const SlamDataset::Sighting polar = by(NoiseReading::kBearingRange);
  ASSERT_TRUE(polar.polar_sigma);
  EXPECT_NEAR(polar.polar_sigma->x(), 0.2, 1e-12);
  // Along the line of sight it is worth 1 / sigma of the range, across 5 m times less.
  const Eigen::Vector2d along(0.6, 0.8), across(-0.8, 0.6);
  EXPECT_NEAR((polar.measurement.sqrt_information * along).norm(), 1.0 / std::sqrt(0.4), 1e-9);
  EXPECT_NEAR((polar.measurement.sqrt_information * across).norm(), 1.0 / (5.0 * 0.2), 1e-9);
}

TEST(LoadSlamDataset, NamesTheLineThatIsWrong) {
  const TemporaryFolder folder;
  const std::string file = Written(folder, "ODOMETRY 0 1 1 0 0 1 0 0 1 0 1\nCONE 1 2\n");
  try {
    LoadSlamDataset(file, NoiseReading::kInformation);
    FAIL();
  } catch (const RecordingError& error) {
    EXPECT_NE(std::string(error.what()).find(":2:"), std::string::npos) << error.what();
  }
}

TEST(EvaluateSlam, CostsNothingWhereAllAgreesAndHalfTheSquaresWhereNot) {
  const TemporaryFolder folder;
  const Config config = Config::Load(HAIRPIN_SOURCE_DIR "/config", "global_mapper");
  const GraphParams params = LoadGlobalMapperConfig(config).params.map.graph;
  for (const auto reading :
       {NoiseReading::kInformation, NoiseReading::kCovariance, NoiseReading::kBearingRange}) {
    const auto exact = LoadSlamDataset(Written(folder, kTwoPoses), reading);
    EXPECT_NEAR(EvaluateSlam(exact, params, 1).final_cost, 0.0, 1e-9);
    std::string text = kTwoPoses;
    text.replace(text.find("2 4 0.4"), 7, "3 4 0.4");
    const auto off = LoadSlamDataset(Written(folder, text), reading);
    EXPECT_GT(EvaluateSlam(off, params, 1).final_cost, 1e-4);
  }
}

}  // namespace
}  // namespace hairpin
