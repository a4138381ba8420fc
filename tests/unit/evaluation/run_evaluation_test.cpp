#include "tools/evaluation/run_evaluation.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tools/evaluation/recording_error.hpp"

namespace hairpin {
namespace {

MappedRunParams Shipped() {
  const auto load = [](const char* daemon) {
    return Config::Load(HAIRPIN_SOURCE_DIR "/config", daemon);
  };
  MappedRunParams params{LoadLidarConeDetectorParams(load("lidar_cone_detector")),
                         LoadLocalMapperParams(load("local_mapper")),
                         LoadGlobalMapperConfig(load("global_mapper")), 64};
  params.global_mapper.known_map.reset();
  params.global_mapper.store.directory.clear();
  return params;
}

std::filesystem::path RealData() {
  const char* from_environment = std::getenv("HAIRPIN_DATA");
  const std::filesystem::path data =
      from_environment ? from_environment : HAIRPIN_SOURCE_DIR "/../shared/data";
  return data / "lidar_run";
}

/// What is asked of a map of the real car, whatever the sensor.
void ExpectGoodMap(const MappedRun& run) {
  EXPECT_EQ(run.scans, 253);
  EXPECT_GT(run.max_speed, 15.0);
  EXPECT_GE(run.comparison.matched, 130);  // 90 % of 144
  ASSERT_TRUE(run.comparison.rmse);
  EXPECT_LE(*run.comparison.rmse, 0.29);
  EXPECT_LE(run.comparison.false_cones, 3);
  EXPECT_EQ(run.comparison.doubled, 0);
  EXPECT_TRUE(run.loop_closed);
}

// Five gaps of 0.6 to 1.8 s are in it, in which the car went up to 14 m.
TEST(RunEvaluation, MapsALapOfARealCar) {
  const std::filesystem::path data = RealData();
  if (!std::filesystem::exists(data / "lap1.fscn.xz")) GTEST_SKIP() << data << " is absent";
  const auto survey = LoadSurveyedMap(data / "map.csv");
  const MappedRun run = MapRecording(data / "lap1.fscn.xz", survey, Shipped());
  ExpectGoodMap(run);
  EXPECT_NE(DrawMappedRun(run, survey).find("RMSE"), std::string::npos);
  const nlohmann::json json = ToJson(run);
  for (const char* key : {"rmse_m", "matched", "missed", "false", "max_speed_mps"})
    EXPECT_TRUE(json.contains(key)) << key;
}

// As sparse as the paper's sensors: a third of the cones that are seen from both sides of a gap.
TEST(RunEvaluation, MapsALapOfARealCarWithHalfTheRings) {
  const std::filesystem::path data = RealData();
  if (!std::filesystem::exists(data / "lap1.fscn.xz")) GTEST_SKIP() << data << " is absent";
  MappedRunParams params = Shipped();
  params.rings = 32;
  ExpectGoodMap(MapRecording(data / "lap1.fscn.xz", LoadSurveyedMap(data / "map.csv"), params));
}

TEST(RunEvaluation, RefusesWhatIsNoRecording) {
  EXPECT_THROW(MapRecording("/nowhere.fscn.xz", {}, Shipped()), RecordingError);
}

}  // namespace
}  // namespace hairpin
