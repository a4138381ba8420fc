#include "tools/report/run_metrics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/synthetic_run.hpp"
#include "tools/report/local_map_metrics.hpp"
#include "tools/report/statistics.hpp"

namespace hairpin {
namespace {

using nlohmann::json;

json Evaluate(const SyntheticRunParams& params) {
  return EvaluateRun(MakeSyntheticRun(params), {});
}

TEST(Map, ShiftedAndTurnedAsAWholeHasNoError) {
  SyntheticRunParams params;
  params.T_map_local = {40.0, -60.0, 2.5};
  const json map = Evaluate(params)["map"];
  EXPECT_NEAR(map["rmse_m"], 0.0, 1e-9);
  EXPECT_EQ(map["false"], 0);
  EXPECT_EQ(map["doubled"], 0);
  EXPECT_GT(map["matched"], 90);
}

TEST(Map, OfAWholeLapMissesNoCone) {
  SyntheticRunParams params;
  params.distance = 174.0;
  const RunLog log = MakeSyntheticRun(params);
  const json map = EvaluateRun(log, {})["map"];
  EXPECT_EQ(map["matched"], log.truth_track->num_cones);
  EXPECT_EQ(map["missed"], 0);
}

TEST(Map, OfHalfALapMissesTheOtherHalf) {
  SyntheticRunParams params;
  params.distance = 60.0;
  const RunLog log = MakeSyntheticRun(params);
  const json map = EvaluateRun(log, {})["map"];
  EXPECT_GT(map["missed"], 20);
  EXPECT_EQ(map["matched"].get<int>() + map["missed"].get<int>(), log.truth_track->num_cones);
}

TEST(Map, NoiseOfTenCentimetresPerAxisIsFourteenInThePlane) {
  SyntheticRunParams params;
  params.position_noise = 0.1;
  const json map = Evaluate(params)["map"];
  EXPECT_NEAR(map["rmse_m"], 0.1414, 0.02);
  EXPECT_GT(map["worst_m"], map["rmse_m"]);
}

TEST(Map, DriftStaysInTheError) {
  SyntheticRunParams params;
  params.yaw_drift_radps = 0.002;
  const json report = Evaluate(params);
  EXPECT_GT(report["map"]["rmse_m"], 0.02);
  EXPECT_LT(report["map"]["rmse_m"], 0.5);
  EXPECT_NEAR(report["drift"]["end_yaw_rad"], 0.002 * 13.0, 0.0005);
  EXPECT_GT(report["drift"]["end_m"], 0.1);
}

TEST(Map, ConesOfASecondVisitAreDoubledNotMatchedTwice) {
  SyntheticRunParams params;
  params.distance = 200.0;
  const RunLog log = MakeSyntheticRun(params);
  const json map = EvaluateRun(log, {})["map"];
  EXPECT_EQ(map["matched"], log.truth_track->num_cones);
  EXPECT_GT(map["doubled"], 10);
  EXPECT_EQ(map["false"], 0);
}

TEST(Map, ACertainConeWhereNoneIsCountsAsFalseAndItsLifeIsMeasured) {
  SyntheticRunParams params;
  params.false_cone = Eigen::Vector2d(40.0, 15.0);
  params.false_until_s = 5.55;  // seen in six local maps, gone in the seventh
  const json report = Evaluate(params);
  EXPECT_EQ(report["map"]["false"], 1);
  EXPECT_EQ(report["false_positive_lifetime_s"]["count"], 1);
  EXPECT_NEAR(report["false_positive_lifetime_s"]["max"], 0.6, 1e-9);
}

TEST(Map, OfARestartedMapperIsAlignedByEpoch) {
  RunLog log = MakeSyntheticRun({});
  const Pose2 T_new_old{-20.0, 4.0, -1.0};
  for (size_t i = log.local_maps.size() / 2; i < log.local_maps.size(); ++i) {
    local_map_t& map = log.local_maps[i];
    map.epoch = 8;
    const Pose2 pose = T_new_old * Pose2{map.x_m, map.y_m, map.yaw_rad};
    map.x_m = pose.x;
    map.y_m = pose.y;
    map.yaw_rad = pose.yaw;
    for (local_cone_t& cone : map.cones) {
      const Eigen::Vector2d moved = T_new_old * Eigen::Vector2d(cone.x_m, cone.y_m);
      cone.x_m = moved.x();
      cone.y_m = moved.y();
    }
  }
  const json map = EvaluateRun(log, {})["map"];
  EXPECT_NEAR(map["rmse_m"], 0.0, 1e-9);
  EXPECT_EQ(map["false"], 0);
}

TEST(Path, InTheMiddleLeavesTheTrackNowhere) {
  const json path = Evaluate({})["path"];
  EXPECT_EQ(path["full_length_percent"], 100.0);
  EXPECT_THAT(path["out_of_track_percent"].get<std::vector<double>>(), testing::Each(0.0));
  EXPECT_EQ(path["out_of_track_percent"].size(), 16u);
}

TEST(Path, ThatLeavesTheTrackIsCountedAtItsFirstMetreOutside) {
  for (const int metre : {3, 7, 15}) {
    SyntheticRunParams params;
    params.path_leaves_at = metre;
    const auto out = Evaluate(params)["path"]["out_of_track_percent"].get<std::vector<double>>();
    for (int k = 0; k < 16; ++k)
      EXPECT_EQ(out[static_cast<size_t>(k)], k == metre ? 100.0 : 0.0) << metre << " " << k;
  }
}

TEST(Path, IsJudgedByItsSeenPartOnly) {
  SyntheticRunParams params;
  params.path_length = 8.4;
  params.path_leaves_at = 10.5;
  const json path = Evaluate(params)["path"];
  EXPECT_EQ(path["full_length_percent"], 0.0);
  EXPECT_EQ(path["length_percent"][8], 100.0);
  EXPECT_THAT(path["out_of_track_percent"].get<std::vector<double>>(), testing::Each(0.0));
}

TEST(Path, OnlyCountsWhileTheCarDrives) {
  RunLog log = MakeSyntheticRun({});
  const json path = EvaluateRun(log, {})["path"];
  EXPECT_EQ(path["count"], static_cast<int>(log.tracks.size()) - 10);  // one second of waiting
  for (as_state_t& state : log.as_states) state.mission_finished = true;
  EXPECT_TRUE(EvaluateRun(log, {})["path"]["full_length_percent"].is_null());
}

TEST(Path, ThatIsMissingCountsAsNotReachingFullLength) {
  RunLog log = MakeSyntheticRun({});
  for (size_t i = 0; i < log.tracks.size(); i += 2) {
    log.tracks[i].valid = false;
    log.tracks[i].path.clear();
    log.tracks[i].num_points = 0;
  }
  const json path = EvaluateRun(log, {})["path"];
  EXPECT_NEAR(path["full_length_percent"], 50.0, 1.0);
  EXPECT_NEAR(path["length_percent"][0], 50.0, 1.0);
}

TEST(Modes, CountFromTheGoAndNameTheCause) {
  SyntheticRunParams params;
  params.fusion_off_s = 4.0;
  const json modes = Evaluate(params)["modes"];
  ASSERT_EQ(modes.size(), 3u);
  EXPECT_EQ(modes[0]["mode"], "FUSION");
  EXPECT_EQ(modes[0]["t_s"], 0.0);
  EXPECT_EQ(modes[1]["mode"], "LIDAR_AND_CAMERA");
  EXPECT_EQ(modes[1]["cause"], "CONES_FUSION is stale");
  EXPECT_NEAR(modes[1]["t_s"], 4.16, 1e-9);
  EXPECT_NEAR(modes[1]["reaction_s"], 0.26, 1e-9);
  EXPECT_EQ(modes[2]["mode"], "FUSION");
  EXPECT_TRUE(modes[2]["reaction_s"].is_null());
}

TEST(Velocity, ErrorIsRootMeanSquareWhileDriving) {
  SyntheticRunParams params;
  params.vx_error = -0.25;
  const json velocity = Evaluate(params)["velocity"];
  EXPECT_NEAR(velocity["vx_rms_mps"], 0.25, 1e-9);
  EXPECT_NEAR(velocity["vy_rms_mps"], 0.0, 1e-9);
  EXPECT_NEAR(velocity["yaw_rate_rms_radps"], 0.0, 1e-9);
}

TEST(Colour, AccuracyFallsWhereColoursAreSwapped) {
  SyntheticRunParams params;
  params.wrong_colour_beyond = 10.0;
  const json colour = Evaluate(params)["colour"];
  for (const int bin : {0, 1, 2}) EXPECT_EQ(colour["accuracy"][static_cast<size_t>(bin)], 1.0);
  for (const int bin : {3, 4}) EXPECT_EQ(colour["accuracy"][static_cast<size_t>(bin)], 0.0);
}

TEST(DataAge, IsTheCommandsTimeLessItsPaths) {
  const json age = Evaluate({})["data_age_ms"];
  EXPECT_NEAR(age["max"], 90.0, 1e-6);
  EXPECT_NEAR(age["p50"], 40.0, 1e-6);
}

TEST(Report, HoldsWhatDriveKnows) {
  RunContext context;
  context.seed = 3;
  context.track = "FSG19";
  context.build = "abc";
  context.real_time_factor = 21.5;
  context.lap = {true, 25.5, 1, 2, 12.1, 9.8, "finished", {25.5}};
  context.latency_ms = {{"local_mapper", {1.0, 3.0, 2.0}}, {"silent", {}}};
  const json report = EvaluateRun(MakeSyntheticRun({}), context);
  EXPECT_EQ(report["seed"], 3);
  EXPECT_EQ(report["track"], "FSG19");
  EXPECT_EQ(report["build"], "abc");
  EXPECT_EQ(report["real_time_factor"], 21.5);
  EXPECT_EQ(report["lap"]["finished"], true);
  EXPECT_EQ(report["lap"]["time_s"], 25.5);
  EXPECT_EQ(report["lap"]["cones_hit"], 1);
  EXPECT_EQ(report["lap"]["off_course"], 2);
  EXPECT_EQ(report["latency_ms"]["local_mapper"]["p50"], 2.0);
  EXPECT_EQ(report["latency_ms"]["local_mapper"]["max"], 3.0);
  EXPECT_TRUE(report["latency_ms"]["silent"]["p99"].is_null());
}

TEST(Report, OfAnEmptyLogHasNullsAndEveryKey) {
  const json report = EvaluateRun({}, {});
  for (const char* key :
       {"/lap/time_s", "/lap/max_speed_mps", "/lap/mean_speed_mps", "/map/rmse_m", "/map/matched",
        "/map/missed", "/map/false", "/path/full_length_percent", "/path/out_of_track_percent",
        "/real_time_factor", "/drift/end_m", "/velocity/vx_rms_mps", "/data_age_ms/p50"}) {
    ASSERT_TRUE(report.contains(json::json_pointer(key))) << key;
    EXPECT_TRUE(report.at(json::json_pointer(key)).is_null()) << key;
  }
  EXPECT_EQ(report["lap"]["finished"], false);
  EXPECT_TRUE(report["modes"].empty());
}

TEST(Report, IsTheSameForTheSameRun) {
  SyntheticRunParams params;
  params.position_noise = 0.1;
  EXPECT_EQ(Evaluate(params).dump(), Evaluate(params).dump());
}

TEST(Statistics, PercentileIsTheNearestRank) {
  EXPECT_EQ(Percentile({4.0, 1.0, 3.0, 2.0}, 50.0), 2.0);
  EXPECT_EQ(Percentile({4.0, 1.0, 3.0, 2.0}, 51.0), 3.0);
  EXPECT_EQ(Percentile({4.0, 1.0, 3.0, 2.0}, 100.0), 4.0);
  EXPECT_EQ(Percentile({}, 50.0), std::nullopt);
  EXPECT_THROW(Percentile({1.0}, 0.0), std::invalid_argument);
  EXPECT_THROW(Percentile({1.0}, 100.5), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
