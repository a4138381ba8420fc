#include "tools/evaluation/lidar_evaluation.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tools/evaluation/lidar_sources.hpp"
#include "tools/evaluation/recorded_scans.hpp"
#include "tools/evaluation/recording_error.hpp"

namespace hairpin {
namespace {

using testing::ElementsAre;

std::filesystem::path RealData() {
  const char* from_environment = std::getenv("HAIRPIN_DATA");
  const std::filesystem::path data =
      from_environment ? from_environment : HAIRPIN_SOURCE_DIR "/../shared/data";
  return data / "lidar_run";
}

std::filesystem::path Written(const std::string& name, const std::string& text) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

TEST(MatchScan, TakesTheNearestPairsFirstAndEachConeOnce) {
  const std::vector<ScannedCone> cones{{{5.0, 0.0}}, {{5.4, 0.0}}, {{9.0, 0.0}}};
  const std::vector<LidarDetection> detections{
      {{5.1, 0.0}}, {{5.3, 0.0}}, {{5.2, 0.2}}, {{7.0, 0.0}}};
  const ScanMatch match = MatchScan(cones, detections);
  EXPECT_THAT(match.detection_of_cone, ElementsAre(0, 1, -1));
  EXPECT_THAT(match.cone_of_detection, ElementsAre(0, 1, -2, -1));
}

TEST(CountReturns, CountsWhatStandsAboveTheGroundAboutACone) {
  PointCloud cloud;
  for (float x = 3.0f; x < 7.0f; x += 0.1f) cloud.Add({x, 0.1f, 0.2f}, 0.0f, 0, 0, 0);
  cloud.Add({5.0f, 0.0f, 0.25f}, 0.0f, 0, 0, 0);  // 5 cm
  cloud.Add({5.0f, 0.0f, 0.27f}, 0.0f, 0, 0, 0);
  cloud.Add({5.2f, 0.0f, 0.40f}, 0.0f, 0, 0, 0);
  cloud.Add({5.5f, 0.0f, 0.40f}, 0.0f, 0, 0, 0);  // beside it
  std::vector<ScannedCone> cones{{{5.0, 0.0}}, {{20.0, 0.0}}};
  CountReturns(cloud, cones);
  EXPECT_EQ(cones[0].returns, 2);
  EXPECT_EQ(cones[1].returns, 0);
}

TEST(LidarFigures, TellRecallPrecisionAndError) {
  LidarFigures figures;
  const std::vector<ScannedCone> cones{{{5.0, 0.0}, ConeColour::kBlue, 9},
                                       {{8.0, 1.0}, ConeColour::kYellow, 3},
                                       {{9.0, 1.0}, ConeColour::kYellow, 2},   // too few returns
                                       {{-9.0, 1.0}, ConeColour::kYellow, 9},  // behind
                                       {{12.0, 0.0}, ConeColour::kBlue, 4}};
  const std::vector<LidarDetection> detections{{{5.04, 0.0}, {0.0, 1.0, 0.0, 0.0, 0.0}},
                                               {{12.0, 0.03}, {0.0, 0.0, 1.0, 0.0, 0.0}},
                                               {{6.0, 2.0}}};
  figures.Add(cones, detections, Eigen::Vector2d::Zero(), {});
  const nlohmann::json json = figures.ToJson();
  EXPECT_EQ(json["scans"], 1);
  EXPECT_EQ(json["recall_0_10m"], 0.5);
  EXPECT_EQ(json["recall_10_15m"], 1.0);
  EXPECT_NEAR(json["precision_15m"].get<double>(), 2.0 / 3.0, 1e-9);
  EXPECT_EQ(json["false_per_scan"], 1.0);
  EXPECT_NEAR(json["position_error_median_m"].get<double>(), 0.03, 1e-9);
  EXPECT_EQ(json["colour_accuracy"][1], 1.0);
  EXPECT_EQ(json["colour_accuracy"][3], 0.0);
  EXPECT_EQ(json["colour_unknown"][3], 0.0);
  EXPECT_TRUE(json["ms_median"].is_null());
}

TEST(RecordedScanReader, RefusesWhatIsNoRecording) {
  EXPECT_THROW(RecordedScanReader("/nowhere.xz"), RecordingError);
  RecordedScanReader reader(Written("no.xz", "this is no xz file at all"));
  EXPECT_THROW(reader.Next(), RecordingError);
}

TEST(LoadSurveyedMap, ReadsConesAndNamesTheLineThatIsWrong) {
  const auto map =
      LoadSurveyedMap(Written("map.csv", "x_m,y_m,colour\r\n1.5,-2,blue\r\n3,4,yellow\r\n"));
  ASSERT_EQ(map.size(), 2u);
  EXPECT_EQ(map[0].position, Eigen::Vector2d(1.5, -2.0));
  EXPECT_EQ(map[1].colour, ConeColour::kYellow);
  try {
    LoadSurveyedMap(Written("bad.csv", "x_m,y_m,colour\n1,2,blue\n1,2,green\n"));
    FAIL();
  } catch (const RecordingError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("line 3"));
  }
}

TEST(LidarEvaluation, FindsTheConesOfARealCar) {
  const std::filesystem::path data = RealData();
  if (!std::filesystem::exists(data / "lap1.fscn.xz")) GTEST_SKIP() << data << " is absent";
  const auto params = LoadLidarConeDetectorParams(
      Config::Load(HAIRPIN_SOURCE_DIR "/config", "lidar_cone_detector"));
  for (const int rings : {64, 32}) {
    LidarFigures figures;
    DetectInRecording(data / "lap1.fscn.xz", data / "map.csv", rings, params,
                      [&](const EvaluatedScan& scan) {
                        figures.Add(scan.truth, scan.detections, scan.sensor, scan.ms);
                      });
    const nlohmann::json json = figures.ToJson();
    EXPECT_EQ(json["scans"], 253);
    EXPECT_GE(json["recall_0_10m"], rings == 64 ? 0.97 : 0.94);
    EXPECT_GE(json["precision_15m"], 0.98);
    EXPECT_LE(json["position_error_median_m"], 0.06);
    EXPECT_GE(json["recall_10_15m"], rings == 64 ? 0.93 : 0.88);
  }
}

}  // namespace
}  // namespace hairpin
