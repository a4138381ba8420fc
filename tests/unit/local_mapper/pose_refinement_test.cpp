#include "daemons/local_mapper/pose_refinement.hpp"

#include <gtest/gtest.h>

#include "tests/unit/local_mapper/params.hpp"

namespace hairpin {
namespace {

using test::Seen;
using test::SetAt;
using test::TestMapperParams;

const AssociationParams kAssociation{.gate_chi2 = 11.8, .gate_sigma = 0.08};
const std::vector<Eigen::Vector2d> kCones{{5.0, 1.5}, {5.2, -1.6}, {9.0, 2.0}, {9.5, -1.0}};
const Pose2 kTruth{3.0, -1.0, 0.4};

std::vector<Gaussian2> Map() {
  std::vector<Gaussian2> map;
  for (const Eigen::Vector2d& cone : kCones)
    map.push_back({kTruth * cone, 1e-4 * Eigen::Matrix2d::Identity()});
  return map;
}

std::vector<ConeObservation> Observed(size_t n) {
  std::vector<ConeObservation> seen;
  for (size_t i = 0; i < n; ++i)
    seen.push_back(Seen(kCones[i].x(), kCones[i].y(), ConeColour::kBlue, 0.02));
  return seen;
}

Eigen::Matrix3d Loose() { return Eigen::Vector3d(0.25, 0.25, 0.01).asDiagonal(); }

TEST(PoseRefinement, FindsThePoseThatTheConesTell) {
  const Pose2 predicted = kTruth * Pose2{0.3, -0.2, 0.03};
  const Pose2 pose = RefinePose(Map(), Observed(4), 1.0, predicted, Loose(), kAssociation, 3);
  const Pose2 error = kTruth.Inverse() * pose;
  EXPECT_LT(error.position().norm(), 0.02);
  EXPECT_LT(std::abs(error.yaw), 0.003);  // a tenth of what was predicted wrong
}

TEST(PoseRefinement, StaysNearAPredictionThatIsTrusted) {
  const Pose2 predicted = kTruth * Pose2{0.05, 0.0, 0.0};
  const Eigen::Matrix3d tight = 1e-8 * Eigen::Matrix3d::Identity();
  const Pose2 pose = RefinePose(Map(), Observed(4), 1.0, predicted, tight, kAssociation, 3);
  EXPECT_LT((predicted.Inverse() * pose).position().norm(), 1e-3);
}

TEST(PoseRefinement, LeavesThePredictionWhereTooFewConesAreKnown) {
  const Pose2 predicted = kTruth * Pose2{0.3, 0.0, 0.0};
  const Pose2 pose = RefinePose(Map(), Observed(2), 1.0, predicted, Loose(), kAssociation, 3);
  EXPECT_EQ(pose.x, predicted.x);
  EXPECT_EQ(pose.yaw, predicted.yaw);
}

TEST(PoseRefinement, IsHardlyMovedByOneWrongPair) {
  std::vector<ConeObservation> seen = Observed(4);
  seen[3].position += Eigen::Vector2d(0.0, 0.35);
  const Pose2 pose = RefinePose(Map(), seen, 1.0, kTruth, Loose(), kAssociation, 3);
  EXPECT_LT((kTruth.Inverse() * pose).position().norm(), 0.08);
}

TEST(PoseRefinement, AllowsForTheDelayWhereTheVelocityChanges) {
  const PoseRefinementParams params{
      .velocity_sigma = 0.3, .yaw_rate_sigma = 0.03, .stamp_sigma = 0.03};
  const Eigen::Matrix3d steady = MotionCovariance(params, 0.1, {});
  const Eigen::Matrix3d turning = MotionCovariance(params, 0.1, {0.0, 0.0, 1.0});
  EXPECT_NEAR(std::sqrt(steady(0, 0)), 0.03, 1e-12);
  EXPECT_NEAR(std::sqrt(steady(2, 2)), 0.003, 1e-12);
  EXPECT_NEAR(turning(2, 2), 0.003 * 0.003 + 0.03 * 0.03, 1e-12);
}

// Scale and misalignment of a velocity sensor, as on a real car: the map stays sharp.
TEST(PoseRefinement, KeepsEachConeOneUnderABiasedVelocity) {
  LocalMapperParams params = TestMapperParams();
  params.map.refinement = {.velocity_sigma = 0.3, .yaw_rate_sigma = 0.03};
  params.trust.fusion.refines_pose = true;
  LocalMapper mapper(params);
  mapper.SetMode(MapMode::kFusion);
  const auto row = [](int i) {
    return Eigen::Vector2d(3.0 * i + 0.4 * (i % 3), i % 2 == 0 ? 1.6 : -1.7);
  };
  constexpr double kSpeed = 10.0;
  std::optional<LocalMapEstimate> map;
  for (int step = 0; step <= 300; ++step) {
    const int64_t utime = 1'000'000 + 10'000 * step;
    mapper.AddVelocity(utime, {1.03 * kSpeed, 0.3, 0.0});
    if (step % 10 != 0) continue;
    const double x = kSpeed * 0.01 * step;
    std::vector<ConeObservation> seen;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector2d cone = row(i) - Eigen::Vector2d(x, 0.0);
      if (cone.x() > 1.0 && cone.norm() < 14.0)
        seen.push_back(Seen(cone.x(), cone.y(), ConeColour::kBlue, 0.05));
    }
    map = mapper.Observe(SetAt(utime, seen)).map;
  }
  ASSERT_TRUE(map);
  EXPECT_LT(std::abs(map->T_local_base.x - 30.0), 0.6);  // 0.9 m by velocity
  EXPECT_LT(std::abs(map->T_local_base.y), 0.5);         // 0.9 m by velocity
  for (const LocalCone& cone : map->cones) {
    if (cone.last_seen_utime != map->utime) continue;
    const Eigen::Vector2d in_base = map->T_local_base.Inverse() * cone.position;
    double nearest = 1e9;
    for (int i = 0; i < 20; ++i)
      nearest = std::min(nearest, (row(i) - Eigen::Vector2d(30.0, 0.0) - in_base).norm());
    EXPECT_LT(nearest, 0.1);
  }
}

}  // namespace
}  // namespace hairpin
