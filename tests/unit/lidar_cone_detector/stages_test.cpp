#include <gmock/gmock.h>

#include <random>

#include "daemons/lidar_cone_detector/acceptance.hpp"
#include "daemons/lidar_cone_detector/cone_fit.hpp"
#include "daemons/lidar_cone_detector/deskew.hpp"
#include "daemons/lidar_cone_detector/expected_returns.hpp"
#include "daemons/lidar_cone_detector/polar_grid.hpp"
#include "daemons/lidar_cone_detector/scan_pairing.hpp"
#include "daemons/lidar_cone_detector/view.hpp"
#include "tests/support/lidar_world.hpp"

namespace hairpin {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
const ConeBody kSmall{0.325, 0.085, 0.025};

TEST(FastBearing, IsTheArcTangent) {
  for (float angle = -3.14f; angle < 3.14f; angle += 0.003f)
    EXPECT_NEAR(FastBearing(7.0f * std::sin(angle), 7.0f * std::cos(angle)), angle, 2e-5f);
  EXPECT_EQ(FastBearing(0.0f, 0.0f), 0.0f);
}

TEST(ExpectedReturns, CountsWhatAnExactCastReturns) {
  const SensorGeometry sensor = UnevenSensor({1.0f, 0.0f, 0.6f}, 0.2f);
  ReturnModel model;
  model.SetSensors(std::vector{sensor});
  for (const float range : {3.0f, 6.0f, 10.0f, 15.0f}) {
    LidarWorld world;
    world.cones.push_back({{range, 0.5f}});
    const LabelledCloud scan = Scan(world, sensor, 0.0f, 30.0f, 1);
    float counted = 0.0f, top = 0.0f;
    for (size_t i = 0; i < scan.hit.size(); ++i) {
      if (scan.hit[i] != 0 || scan.cloud.z[i] < 0.05f) continue;
      counted += 1.0f;
      top = std::max(top, scan.cloud.z[i]);
    }
    const ExpectedReturns expected = model.Expect(range, 0.5f, 0.0f, kSmall, 0.05f);
    EXPECT_NEAR(expected.most, counted, 0.15f * counted + 2.0f) << range;
    EXPECT_NEAR(expected.top, top, 0.03f) << range;
    EXPECT_EQ(expected.all, expected.most);
  }
}

TEST(ConeFit, FindsTheAxisAndNotTheMeanOfTheVisibleSurface) {
  std::vector<ConeReturn> returns;
  for (const float height : {0.1f, 0.2f}) {
    for (float angle = -1.2f; angle <= 1.2f; angle += 0.3f) {
      const float radius = kSmall.RadiusAt(height);  // the side that faces a sensor at the origin
      returns.push_back({{8.0f - radius * std::cos(angle), radius * std::sin(angle)}, height});
    }
  }
  const ConeFit fit = FitCone(returns, Eigen::Vector2f::Zero(), kSmall, {0.03, 0.04});
  EXPECT_NEAR(fit.axis.x(), 8.0f, 0.005f);
  EXPECT_NEAR(fit.axis.y(), 0.0f, 0.002f);
  EXPECT_LT(fit.residual, 0.005f);
}

TEST(ConeFit, TurnsWithTheWorld) {
  const std::vector<ConeReturn> returns{{{5.0f, 0.02f}, 0.1f}, {{5.02f, -0.03f}, 0.2f}};
  const Eigen::Rotation2Df turn(1.1f);
  std::vector<ConeReturn> turned = returns;
  for (ConeReturn& point : turned) point.position = turn * point.position;
  const Eigen::Vector2f sensor(1.0f, 0.0f);
  const Eigen::Vector2f axis = FitCone(returns, sensor, kSmall, {0.03, 0.04}).axis;
  const Eigen::Vector2f turned_axis = FitCone(turned, turn * sensor, kSmall, {0.03, 0.04}).axis;
  EXPECT_NEAR((turn * axis - turned_axis).norm(), 0.0f, 1e-5f);
}

TEST(Acceptance, JudgesByNumberHeightAndShape) {
  const AcceptanceParams params{2, 0.2, 1.8, 4.0, 0.12, 0.05, 0.06};
  const ConeEvidence cone{10, 0.28f, 0.02f, 0.325f, {12.0f, 12.0f, 0.3f}};
  const auto judge = [&](auto change) {
    ConeEvidence evidence = cone;
    change(evidence);
    return Judge(evidence, params);
  };
  EXPECT_EQ(judge([](ConeEvidence&) {}), Verdict::kCone);
  EXPECT_EQ(judge([](ConeEvidence& e) { e.returns = 1; }), Verdict::kTooFew);
  EXPECT_EQ(judge([](ConeEvidence& e) { e.returns = 2; }), Verdict::kTooFew);
  EXPECT_EQ(judge([](ConeEvidence& e) { e.returns = 26; }), Verdict::kTooMany);
  EXPECT_EQ(judge([](ConeEvidence& e) { e.top = 0.15f; }), Verdict::kTooLow);
  EXPECT_EQ(judge([](ConeEvidence& e) { e.top = 0.39f; }), Verdict::kTooHigh);
  EXPECT_EQ(judge([](ConeEvidence& e) { e.residual = 0.07f; }), Verdict::kNoCone);
}

TEST(Deskew, CarriesAPointAlongByWhatTheCarMovedSince) {
  PoseHistory history(1.0);
  for (int i = 0; i <= 20; ++i) history.Add(1'000'000 + i * 10'000, {10.0, 0.0, 0.0});
  const int64_t utime = 1'200'000;
  const auto motion = MotionTable::Make(history, utime, 0.1);
  ASSERT_TRUE(motion);
  Eigen::Isometry3f mount = Eigen::Isometry3f::Identity();
  mount.translation() = Eigen::Vector3f(1.0f, 0.0f, 0.5f);
  const std::vector<LidarPoint> points{{{5.0f, 2.0f, -0.4f}, 7, 3, 0.05f},
                                       {{0.0f, 0.1f, 0.0f}, 7, 3, 0.0f}};
  PointCloud cloud;
  Deskew(points, mount, 0.02f, *motion, {-1.0f, 1.5f, 0.8f}, 1, cloud);
  ASSERT_EQ(cloud.size(), 1u);  // the other is the car's own
  EXPECT_NEAR(cloud.x[0], 6.0f - 0.7f, 1e-3f);
  EXPECT_NEAR(cloud.y[0], 2.0f, 1e-4f);
  EXPECT_NEAR(cloud.z[0], 0.1f, 1e-5f);
  EXPECT_NEAR(cloud.age[0], 0.07f, 1e-6f);
  EXPECT_EQ(cloud.sensor[0], 1);
}

TEST(Deskew, IsNotPossibleWithoutVelocityOfThatTime) {
  PoseHistory history(1.0);
  EXPECT_FALSE(MotionTable::Make(history, 1'000'000, 0.1));
  history.Add(1'000'000, {});
  EXPECT_FALSE(MotionTable::Make(history, 1'050'000, 0.1)) << "begins after the oldest point";
  EXPECT_FALSE(MotionTable::Make(history, 1'200'000, 0.05)) << "ends before the newest";
}

TEST(View, IsWhatPointsCameFrom) {
  PointCloud cloud;
  for (float bearing = -1.0f; bearing < 1.5f; bearing += 0.005f)
    cloud.Add({10.0f * std::cos(bearing), 10.0f * std::sin(bearing), 0.0f}, 0.0f, 0, 0, 0);
  cloud.Add({-5.0f, 0.1f, 0.0f}, 0.0f, 0, 0, 0);  // alone
  const std::vector<LookedAt> sectors = SectorsLookedAt(cloud, 16);
  ASSERT_EQ(sectors.size(), 1u);
  EXPECT_NEAR(sectors[0].min_bearing, -1.0f, 0.05f);
  EXPECT_NEAR(sectors[0].max_bearing, 1.5f, 0.05f);
  EXPECT_TRUE(SectorsLookedAt(PointCloud{}, 16).empty());
}

TEST(View, DoesNotEndBehindTheCar) {
  PointCloud cloud;
  for (float bearing = 2.0f; bearing < 4.0f; bearing += 0.005f)
    cloud.Add({10.0f * std::cos(bearing), 10.0f * std::sin(bearing), 0.0f}, 0.0f, 0, 0, 0);
  const std::vector<LookedAt> sectors = SectorsLookedAt(cloud, 16);
  ASSERT_EQ(sectors.size(), 1u);
  EXPECT_NEAR(sectors[0].max_bearing - sectors[0].min_bearing, 2.0f, 0.08f);
}

LidarRevolution At(int64_t utime) {
  LidarRevolution scan;
  scan.utime = utime;
  return scan;
}

TEST(ScanPairing, PutsScansOfAboutTheSameTimeTogether) {
  ScanPairing pairing({0.06, 0.1, 0.25});
  ASSERT_TRUE(pairing.Add(0, At(1'000'000)));
  ASSERT_TRUE(pairing.Add(1, At(1'030'000)));
  const auto set = pairing.Take(1'030'000);
  ASSERT_TRUE(set);
  EXPECT_TRUE(set->scans[0] && set->scans[1]);
  EXPECT_EQ(set->utime, 1'030'000);
  EXPECT_FALSE(pairing.Take(2'000'000));
}

TEST(ScanPairing, WaitsForAPartnerThatLivesAndNotForADeadOne) {
  ScanPairing pairing({0.06, 0.1, 0.25});
  ASSERT_TRUE(pairing.Add(1, At(1'000'000)));
  ASSERT_TRUE(pairing.Take(1'000'000)) << "the other was never heard";
  ASSERT_TRUE(pairing.Add(0, At(1'090'000)));
  EXPECT_FALSE(pairing.Take(1'140'000));
  const auto late = pairing.Take(1'150'000);
  ASSERT_TRUE(late);
  EXPECT_FALSE(late->scans[1]);
  ASSERT_TRUE(pairing.Add(0, At(1'300'000)));
  EXPECT_TRUE(pairing.Take(1'300'000)) << "silent for its deadline";
}

TEST(ScanPairing, ScansFarApartGoOneByOneInTheOrderOfTime) {
  ScanPairing pairing({0.06, 0.1, 0.25});
  ASSERT_TRUE(pairing.Add(0, At(1'080'000)));
  ASSERT_TRUE(pairing.Add(1, At(1'000'000)));
  EXPECT_EQ(pairing.Take(1'080'000)->utime, 1'000'000);
  EXPECT_FALSE(pairing.Take(1'080'000));
  EXPECT_EQ(pairing.MakeRoom(0)->utime, 1'080'000);
  EXPECT_FALSE(pairing.MakeRoom(0));
}

TEST(ScanPairing, DropsAScanWhoseTimeDoesNotIncrease) {
  ScanPairing pairing({0.06, 0.1, 0.25});
  ASSERT_TRUE(pairing.Add(0, At(1'000'000)));
  ASSERT_TRUE(pairing.Take(1'100'000));
  EXPECT_FALSE(pairing.Add(0, At(1'000'000)));
}

}  // namespace
}  // namespace hairpin
