#include "daemons/global_mapper/pose_landmark_graph.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/synthetic_lap.hpp"

namespace hairpin {
namespace {

GraphParams Params() {
  GraphParams params;
  params.window = {5, 0.0, 1e-4};
  params.full = {20, 0.0, 1e-6};
  params.window_poses = 15;
  return params;
}

double WorstDifference(const SyntheticLapDriver& a, const SyntheticLapDriver& b) {
  double worst = 0.0;
  for (size_t c = 0; c < SyntheticLap::kCones; ++c)
    worst = std::max(worst, (a.cone(c) - b.cone(c)).norm());
  return worst;
}

SyntheticLapDriver Batch(const SyntheticLap& lap) {
  SyntheticLapDriver batch(Params(), lap.poses()[0]);
  for (const auto& step : lap.steps()) batch.Add(step);
  EXPECT_TRUE(batch.graph().SolveAll());
  return batch;
}

TEST(PoseLandmarkGraph, FindsTheConesOfALapFromDeadReckoning) {
  const SyntheticLap lap(1);
  SyntheticLapDriver batch = Batch(lap);
  double squares = 0.0;
  for (size_t c = 0; c < SyntheticLap::kCones; ++c)
    squares += (batch.cone(c) - lap.cones()[c]).squaredNorm();
  EXPECT_LT(std::sqrt(squares / SyntheticLap::kCones), 0.15);
  // 24,600 + 1,797 residuals less 2,097 unknowns, half of which is what noise leaves.
  EXPECT_NEAR(batch.graph().Cost(), 0.5 * (24600 + 1797 - 2097), 300.0);
}

TEST(PoseLandmarkGraph, IsTheSameInTheEndWhenSolvedInWindowsAndMarginalised) {
  const SyntheticLap lap(2, 2);
  SyntheticLapDriver windows(Params(), lap.poses()[0]);
  size_t i = 0;
  for (const auto& step : lap.steps()) {
    windows.Add(step);
    const bool closes = ++i % SyntheticLap::kPoses == SyntheticLap::kPoses - 1 || i == 625;
    ASSERT_TRUE(closes ? windows.graph().SolveAll() : windows.graph().SolveWindow());
    for (int k = 0; k < 2 && i > 700 && windows.graph().num_poses() > 300; ++k)
      windows.graph().MarginaliseOldest();
  }
  ASSERT_TRUE(windows.graph().SolveAll());
  EXPECT_EQ(windows.graph().num_poses(), 300u);
  EXPECT_LT(WorstDifference(windows, Batch(lap)), 0.01);
}

TEST(PoseLandmarkGraph, IsAfterTenLapsWithinACentimetreOfAllTenSolvedAtOnce) {
  const SyntheticLap lap(3, 10);
  SyntheticLapDriver windows(Params(), lap.poses()[0]);
  for (const auto& step : lap.steps()) ASSERT_TRUE(windows.Drive(step, 100, 100));
  EXPECT_LE(windows.graph().num_poses(), 100u);
  SyntheticLapDriver batch = Batch(lap);
  EXPECT_EQ(batch.graph().num_poses(), 6000u);
  EXPECT_LT(WorstDifference(windows, batch), 0.01);
}

// Most landmarks are known to the prior alone then.
TEST(PoseLandmarkGraph, LosesNothingOfASolutionByMarginalising) {
  const SyntheticLap lap(4);
  const SyntheticLapDriver before = Batch(lap);
  SyntheticLapDriver after = before;
  while (after.graph().num_poses() > 50) after.graph().MarginaliseOldest();
  const auto whole = before.graph().LandmarkCovariances();
  const auto marginal = after.graph().LandmarkCovariances();
  for (size_t l = 0; l < whole.size(); ++l)
    EXPECT_LT((marginal[l] - whole[l]).norm(), 1e-3 * whole[l].norm()) << l;
  ASSERT_TRUE(after.graph().SolveAll());
  EXPECT_LT(WorstDifference(before, after), 1e-4);
}

TEST(PoseLandmarkGraph, MergesALandmarkIntoAnotherEvenAfterMarginalising) {
  PoseLandmarkGraph graph(Params());
  const OdometryMeasurement metre{{1.0, 0.0, 0.0}, 20.0 * Eigen::Matrix3d::Identity()};
  const auto see = [&](size_t landmark, double x, double y) {
    graph.AddSighting(landmark, {{x, y}, 10.0 * Eigen::Matrix2d::Identity()});
  };
  const size_t a = graph.AddLandmark({3.0, 1.0});
  const size_t other = graph.AddLandmark({4.0, -1.0});
  const size_t b = graph.AddLandmark({3.2, 1.2});
  see(a, 3.0, 1.0);
  see(other, 4.0, -1.0);
  graph.AddPose(metre);
  see(b, 2.2, 1.2);
  see(other, 3.0, -1.0);
  graph.AddPose(metre);
  graph.MarginaliseOldest();
  graph.MarginaliseOldest();
  graph.MergeLandmark(b, a);
  ASSERT_TRUE(graph.SolveAll());
  EXPECT_FALSE(graph.IsLandmark(b));
  EXPECT_NEAR(graph.landmark(a).x(), 3.1, 0.06);
  EXPECT_NEAR(graph.landmark(a).y(), 1.1, 0.06);
}

TEST(PoseLandmarkGraph, TellsCovariancesThatGrowAlongAnOpenTrack) {
  PoseLandmarkGraph graph(Params());
  std::vector<size_t> landmarks;
  for (int i = 0; i < 20; ++i) {
    if (i > 0) graph.AddPose({{1.0, 0.0, 0.0}, 50.0 * Eigen::Matrix3d::Identity()});
    landmarks.push_back(graph.AddLandmark({i + 1.0, 1.0}));
    graph.AddSighting(landmarks.back(), {{1.0, 1.0}, 20.0 * Eigen::Matrix2d::Identity()});
  }
  ASSERT_TRUE(graph.SolveAll());
  const auto covariances = graph.LandmarkCovariances();
  // The first is seen from a pose that is known: what is left is the sighting's own variance.
  EXPECT_NEAR(covariances[landmarks[0]].trace() / 2.0, 1.0 / 400.0, 1e-5);
  for (size_t i = 1; i < landmarks.size(); ++i)
    EXPECT_GT(covariances[landmarks[i]].trace(), covariances[landmarks[i - 1]].trace());
}

// FAULTS row 37: the last good map stays.
TEST(PoseLandmarkGraph, StaysAsItWasWhereTheSolverFails) {
  PoseLandmarkGraph graph(Params());
  const size_t landmark = graph.AddLandmark({3.0, 1.0});
  graph.AddSighting(landmark, {{std::nan(""), 1.0}, Eigen::Matrix2d::Identity()});
  EXPECT_FALSE(graph.SolveAll());
  EXPECT_EQ(graph.landmark(landmark), Eigen::Vector2d(3.0, 1.0));
}

TEST(PoseLandmarkGraph, RefusesSightingsOfLandmarksThatThereAreNot) {
  PoseLandmarkGraph graph(Params());
  EXPECT_THROW(graph.AddSighting(0, {}), std::invalid_argument);
}

TEST(GraphParams, RefuseAWindowOfOne) {
  GraphParams params = Params();
  params.window_poses = 1;
  EXPECT_THROW(PoseLandmarkGraph{params}, std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
