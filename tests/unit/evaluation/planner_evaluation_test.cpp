#include "tools/evaluation/planner_evaluation.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "daemons/boundary_estimator/boundary_estimator_node.hpp"
#include "tools/evaluation/frame_picture.hpp"

namespace hairpin {
namespace {

using nlohmann::json;

BoundaryEstimatorParams ShippedParams() {
  return LoadBoundaryEstimatorParams(
      Config::Load(HAIRPIN_SOURCE_DIR "/config", "boundary_estimator"));
}

/// A file of its own for each test.
class Recording {
 public:
  explicit Recording(const std::string& text)
      : path_(testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name() +
              ".json") {
    std::ofstream(path_) << text;
  }
  ~Recording() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

json Frame(double x, const json& yellow, const json& blue) {
  return {{"car_position", {x, 0.0}},
          {"car_direction", {1.0, 0.0}},
          {"car_speed", 5.0},
          {"slam_cones", {json::array(), yellow, blue, json::array(), json::array()}}};
}

// A straight lane along x, 40 m long, driven a metre a frame; the first half of the frames know its
// first 12 m only.
json StraightRun() {
  json run = json::array();
  for (int i = 0; i < 20; ++i) {
    json yellow = json::array(), blue = json::array();
    for (int k = 0; k <= 10; ++k) {
      if (i < 10 && k > 3) break;
      yellow.push_back({4.0 * k, -1.6});
      blue.push_back({4.0 * k, 1.6});
    }
    run.push_back(Frame(i, yellow, blue));
  }
  return run;
}

TEST(RecordedRun, IsReadAsItStands) {
  const Recording file(R"([{"car_position": [1, 2], "car_direction": [0, 2], "car_speed": 3,
      "slam_cones": [[[5, 0]], [[6, 1]], [[7, 2]], [[8, 3]], [[9, 4]]]}])");
  const std::vector<RecordedFrame> run = LoadRecordedRun(file.path());
  ASSERT_EQ(run.size(), 1U);
  EXPECT_EQ(run[0].T_map_base.position(), Eigen::Vector2d(1.0, 2.0));
  EXPECT_NEAR(run[0].T_map_base.yaw, 1.5707963, 1e-6);
  EXPECT_EQ(run[0].speed, 3.0);
  const ConeColour colours[] = {ConeColour::kUnknown, ConeColour::kYellow, ConeColour::kBlue,
                                ConeColour::kOrange, ConeColour::kOrangeLarge};
  ASSERT_EQ(run[0].cones.size(), 5U);
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(MostProbable(run[0].cones[i].colour), colours[i]);
    EXPECT_EQ(run[0].cones[i].position,
              Eigen::Vector2d(5.0 + static_cast<double>(i), static_cast<double>(i)));
  }
}

TEST(RecordedRun, MayLackTheSpeed) {
  json run = StraightRun();
  run[0].erase("car_speed");
  const Recording file(run.dump());
  EXPECT_FALSE(LoadRecordedRun(file.path())[0].speed);
}

TEST(RecordedRun, IsRefusedWithFileFrameAndReason) {
  const auto problem = [](const std::string& text) {
    const Recording file(text);
    try {
      LoadRecordedRun(file.path());
    } catch (const RecordingError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith(file.path() + ": "));
      return std::string(error.what()).substr(file.path().size() + 2);
    }
    return std::string("accepted");
  };
  EXPECT_THAT(problem("{"), testing::HasSubstr("no JSON"));
  EXPECT_THAT(problem("{}"), testing::HasSubstr("no list of frames"));
  EXPECT_THAT(problem("[]"), testing::HasSubstr("no list of frames"));
  EXPECT_EQ(problem("[1]"), "frame 0: is no object");
  json run = StraightRun();
  run[3].erase("car_direction");
  EXPECT_EQ(problem(run.dump()), "frame 3: car_direction: is missing");
  run = StraightRun();
  run[3]["car_speed"] = "fast";
  EXPECT_EQ(problem(run.dump()), "frame 3: car_speed: is no finite number");
  run = StraightRun();
  run[2]["car_position"] = {1.0};
  EXPECT_EQ(problem(run.dump()), "frame 2: car_position: must be [x, y]");
  run[2]["car_position"] = {1.0, nullptr};
  EXPECT_EQ(problem(run.dump()), "frame 2: car_position: is no finite number");
  run = StraightRun();
  run[0]["car_direction"] = {0.0, 0.0};
  EXPECT_EQ(problem(run.dump()), "frame 0: car_direction: is zero");
  run = StraightRun();
  run[1]["slam_cones"] = json::array({json::array(), json::array()});
  EXPECT_EQ(problem(run.dump()), "frame 1: slam_cones: must be five lists");
  run = StraightRun();
  run[1]["slam_cones"][2][0] = {"a", "b"};
  EXPECT_EQ(problem(run.dump()), "frame 1: slam_cones[2]: is no finite number");
  EXPECT_THROW(LoadRecordedRun("/nowhere.json"), RecordingError);
}

TEST(RecordedTrack, KnowsTheSeenStretchAndTheSides) {
  const Recording file(StraightRun().dump());
  const std::vector<RecordedFrame> run = LoadRecordedRun(file.path());
  const RecordedTrack track(run);
  // Cones end at 12 m, 1.6 m aside: the last point within 4.5 m of one is at 12 + sqrt(4.5^2
  // - 1.6^2) = 16.2 m.
  EXPECT_NEAR(track.SeenLength(run, 2, 15.0), 14.2, 0.11);
  EXPECT_NEAR(track.SeenLength(run, 9, 15.0), 7.2, 0.11);
  // The recording ends at 19 m and never comes back.
  EXPECT_NEAR(track.SeenLength(run, 12, 15.0), 7.0, 1e-9);
  // Cones up to 20 m stand beside the driven line.
  EXPECT_EQ(track.boundaries().size(), 10U);
}

TEST(RecordedTrack, GoesOnWithTheLapBefore) {
  std::vector<RecordedFrame> run;
  constexpr double kRadius = 15.0;
  for (int i = 0; i < 220; ++i) {
    RecordedFrame& frame = run.emplace_back();
    const double angle = i / kRadius;
    frame.T_map_base = {kRadius * std::sin(angle), kRadius * (1.0 - std::cos(angle)), angle};
  }
  const RecordedTrack track(run);
  const Polyline ahead = track.DrivenAhead(215, 20.0);
  EXPECT_GE(Length(ahead), 20.0);
  for (const Eigen::Vector2d& point : ahead)
    EXPECT_NEAR((point - Eigen::Vector2d(0.0, kRadius)).norm(), kRadius, 0.1);
  for (size_t i = 1; i < ahead.size(); ++i) EXPECT_LT((ahead[i] - ahead[i - 1]).norm(), 2.0);
}

TEST(EvaluatePlanner, ReportsKnownFiguresOfAStraightRun) {
  const Recording file(StraightRun().dump());
  const json figures = ToJson(EvaluatePlanner(LoadRecordedRun(file.path()), ShippedParams()));
  EXPECT_EQ(figures["frames"], 20);
  EXPECT_EQ(figures["reach_seen_percent"], 100.0);
  EXPECT_EQ(figures["cross_15m_percent"], 0.0);
  EXPECT_EQ(figures["cross_observed_percent"], 0.0);
  EXPECT_EQ(figures["no_path_percent"], 0.0);
  // All frames that know 40 m reach 15 m on cones; of the others the cones end 12 m from the start.
  EXPECT_EQ(figures["reach_15m_on_cones_percent"], 50.0);
  EXPECT_GE(figures["reach_15m_percent"], 55.0);
  EXPECT_LE(figures["reach_15m_percent"], 75.0);
  for (const char* key : {"ms_median", "ms_p95", "ms_max"}) EXPECT_GE(figures[key], 0.0);
}

TEST(EvaluatePlanner, SeesAPathThatCrossesTheFinalMap) {
  json run = StraightRun();
  // Only later frames know that the lane is closed off at 14 m by two blue cones on either side of
  // it.
  for (size_t i = 10; i < 20; ++i) {
    run[i]["slam_cones"][2] = {{0.0, 1.6}, {4.0, 1.6}, {8.0, 1.6}, {13.9, 1.6}, {14.1, -1.6}};
    run[i]["slam_cones"][1] = {{0.0, -1.6}, {4.0, -1.6}, {8.0, -1.6}};
  }
  const Recording file(run.dump());
  const PlannerReport report = EvaluatePlanner(LoadRecordedRun(file.path()), ShippedParams());
  EXPECT_TRUE(report.frames[4].crosses);
  EXPECT_TRUE(report.frames[4].crosses_observed);
}

TEST(EvaluatePlanner, CountsFramesWithoutAPathAsShort) {
  json run = StraightRun();
  for (json& frame : run)
    frame["slam_cones"] =
        json::array({json::array(), json::array(), json::array(), json::array(), json::array()});
  const Recording file(run.dump());
  const json figures = ToJson(EvaluatePlanner(LoadRecordedRun(file.path()), ShippedParams()));
  EXPECT_EQ(figures["reach_15m_percent"], 0.0);
  EXPECT_EQ(figures["no_path_percent"], 100.0);
}

TEST(FramePicture, ShowsTheConesAndThePath) {
  const Recording file(StraightRun().dump());
  const std::vector<RecordedFrame> run = LoadRecordedRun(file.path());
  const PlannerReport report = EvaluatePlanner(run, ShippedParams());
  const std::string picture = DrawFrame(run, 3, report.frames[3]);
  EXPECT_THAT(picture, testing::StartsWith("<svg"));
  EXPECT_THAT(picture, testing::HasSubstr("stroke-dasharray"));
  size_t cones = 0;
  for (size_t at = 0; (at = picture.find("<circle", at)) != std::string::npos; ++at) ++cones;
  EXPECT_EQ(cones, run[3].cones.size());
}

int ExitCode(const std::string& arguments) {
  const std::string command =
      HAIRPIN_BINARY_DIR "/bin/hairpin-evaluate " + arguments + " >/dev/null 2>&1";
  return WEXITSTATUS(std::system(command.c_str()));
}

TEST(HairpinEvaluate, ExitsAsToolsDo) {
  const std::string config = " --config-dir " HAIRPIN_SOURCE_DIR "/config ";
  const Recording good(StraightRun().dump());
  EXPECT_EQ(ExitCode("planner --json" + config + good.path()), 0);
  EXPECT_EQ(ExitCode("--help"), 0);
  EXPECT_EQ(ExitCode("planner"), 2);
  EXPECT_EQ(ExitCode("nothing"), 2);
  EXPECT_EQ(ExitCode("planner /nowhere.json" + config), 78);
  EXPECT_EQ(ExitCode("planner --set max_cones=0" + config + good.path()), 78);
  EXPECT_EQ(
      ExitCode("planner --picture 99 --out " + testing::TempDir() + "x.svg" + config + good.path()),
      78);
}

TEST(HairpinEvaluate, RefusesAMalformedRecording) {
  const Recording bad("[{}]");
  EXPECT_EQ(ExitCode("planner --config-dir " HAIRPIN_SOURCE_DIR "/config " + bad.path()), 78);
}

TEST(RecordedLaps, ReachFarAndCrossLittle) {
  const char* folder = std::getenv("HAIRPIN_DATA");
  const std::string data = folder != nullptr ? folder : HAIRPIN_SOURCE_DIR "/../shared/data";
  const std::string file = data + "/runs/ft_fsd/fsg_19_2_laps.json";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "real data absent: " << file;
  const json figures = ToJson(EvaluatePlanner(LoadRecordedRun(file), ShippedParams()));
  EXPECT_EQ(figures["frames"], 440);
  EXPECT_GE(figures["reach_seen_percent"], 98.0);
  EXPECT_GE(figures["reach_15m_percent"], 75.0);
  EXPECT_LE(figures["cross_15m_percent"], 1.1);
  EXPECT_LE(figures["cross_observed_percent"], 0.3);
  EXPECT_GE(figures["reach_15m_on_cones_percent"], 80.0);
}

}  // namespace
}  // namespace hairpin
