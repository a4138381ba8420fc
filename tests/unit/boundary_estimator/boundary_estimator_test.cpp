#include "daemons/boundary_estimator/boundary_estimator.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>

#include "tests/unit/boundary_estimator/shipped_params.hpp"
#include "tests/unit/boundary_estimator/synthetic_run.hpp"

namespace hairpin {
namespace {

using test::Cone;
using test::ShippedParams;

std::vector<MapCone> ConesOf(const test::SyntheticTrack& track) {
  std::vector<MapCone> cones;
  for (const auto& p : track.left)
    cones.push_back(Cone(static_cast<int64_t>(cones.size()) + 1, p.x(), p.y(), ConeColour::kBlue));
  for (const auto& p : track.right)
    cones.push_back(
        Cone(static_cast<int64_t>(cones.size()) + 1, p.x(), p.y(), ConeColour::kYellow));
  return cones;
}

// A lane that bends left after a straight, with its cones slightly off so that no two distances are
// equal.
std::vector<MapCone> BendingLane(double straight = 12.0) {
  std::vector<MapCone> cones = ConesOf(test::MakeLane({{straight}, {12.0, 0.1}}));
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.05);
  for (MapCone& cone : cones) cone.position += Eigen::Vector2d(noise(random), noise(random));
  return cones;
}

TrackEstimate Estimate(const std::vector<MapCone>& cones, const Pose2& pose = {1.0, 0.2, 0.0}) {
  BoundaryEstimator estimator(ShippedParams());
  return estimator.Estimate(pose, cones);
}

void WithoutColour(std::vector<MapCone>& cones) {
  for (MapCone& cone : cones) cone.colour = kColourUnknown;
}

// Largest distance of the path's first `length` metres from the centreline.
double LargestOffset(const MiddlePath& path, const test::Line& centre, double length) {
  double largest = 0.0, done = 0.0;
  for (size_t i = 1; i < path.points.size() && done < length; ++i) {
    done += (path.points[i].position - path.points[i - 1].position).norm();
    double least = 1e9;
    for (const auto& point : centre)
      least = std::min(least, (point - path.points[i].position).norm());
    largest = std::max(largest, least);
  }
  return largest;
}

TEST(BoundaryEstimator, RunsAlongTheMiddleOfALane) {
  const test::SyntheticTrack track = test::MakeLane({{12.0}, {20.0, 0.1}});
  const TrackEstimate estimate = Estimate(ConesOf(track), {1.0, 0.0, 0.0});
  ASSERT_TRUE(estimate.valid);
  EXPECT_EQ(estimate.fallback, Fallback::kNone);
  EXPECT_GE(estimate.path.seen_length, 15.0);
  EXPECT_LT(LargestOffset(estimate.path, track.centre, 15.0), 0.4);
  EXPECT_EQ(estimate.path.points.front().position, Eigen::Vector2d(1.0, 0.0));
  EXPECT_NEAR(estimate.path.points[5].width, 3.2, 0.05);
  EXPECT_EQ(estimate.winner.log_likelihood, 0.0);
}

// At the start nothing stands behind the car. Two phantoms far to its sides then put it into a
// triangle whose other corners are another stretch's.
TEST(BoundaryEstimator, BeginsInItsOwnLaneWhereItPassesConesOfAnotherBeforeTheFirstGate) {
  std::vector<MapCone> cones;
  const auto add = [&](double x, double y, ConeColour colour) {
    cones.push_back(Cone(static_cast<int64_t>(cones.size()) + 1, x, y, colour));
  };
  for (const auto& [x, y] : {std::pair{3.3, 1.5},
                             {7.7, 1.7},
                             {12.8, 1.7},
                             {17.7, 1.6},
                             {0.7, 5.6},
                             {5.6, 5.5},
                             {10.5, 5.5},
                             {15.3, 5.1},
                             {20.2, 4.7}})
    add(x, y, ConeColour::kBlue);
  for (const auto& [x, y] : {std::pair{3.3, -1.6},
                             {7.6, -1.6},
                             {12.8, -1.7},
                             {17.7, -1.9},
                             {21.6, -2.6},
                             {0.3, 8.9},
                             {5.3, 9.0},
                             {10.3, 9.1},
                             {15.3, 8.6}})
    add(x, y, ConeColour::kYellow);
  for (const auto& [x, y] : {std::pair{20.4, -0.1}, {0.9, -20.5}, {0.2, 21.1}})
    add(x, y, ConeColour::kUnknown);
  const TrackEstimate estimate = Estimate(cones, {0.0, 0.0, 0.0});
  ASSERT_TRUE(estimate.valid);
  EXPECT_EQ(estimate.left.front().id, 1);
  EXPECT_EQ(estimate.right.front().id, 10);
  for (const PathPoint& point : estimate.path.points) {
    if (point.position.x() < 15.0) {
      EXPECT_LT(std::abs(point.position.y()), 0.5);
    }
  }
}

TEST(BoundaryEstimator, FollowsAHairpinOfNineMetresOutsideDiameter) {
  const test::SyntheticTrack track = test::MakeLane({{8.0}, {9.1, 1.0 / 2.9}, {12.0}}, 3.2, 3.0);
  const TrackEstimate estimate = Estimate(ConesOf(track), {2.0, 0.0, 0.0});
  ASSERT_TRUE(estimate.valid);
  EXPECT_GE(estimate.path.seen_length, 15.0);
  EXPECT_LT(LargestOffset(estimate.path, track.centre, 15.0), 0.9);
  EXPECT_GE(test::LengthInside(estimate.path.points, track), 15.0);
}

TEST(BoundaryEstimator, MirroredWorldMirrorsPathAndBoundaries) {
  std::vector<MapCone> cones = BendingLane();
  const TrackEstimate original = Estimate(cones, {1.0, 0.2, 0.1});
  for (MapCone& cone : cones) {
    cone.position.y() *= -1.0;
    std::swap(cone.colour[static_cast<size_t>(ConeColour::kBlue)],
              cone.colour[static_cast<size_t>(ConeColour::kYellow)]);
  }
  const TrackEstimate mirrored = Estimate(cones, {1.0, -0.2, -0.1});
  ASSERT_TRUE(original.valid && mirrored.valid);
  ASSERT_EQ(original.path.points.size(), mirrored.path.points.size());
  for (size_t i = 0; i < original.path.points.size(); ++i) {
    EXPECT_NEAR(original.path.points[i].position.x(), mirrored.path.points[i].position.x(), 1e-9);
    EXPECT_NEAR(original.path.points[i].position.y(), -mirrored.path.points[i].position.y(), 1e-9);
  }
  ASSERT_EQ(original.left.size(), mirrored.right.size());
  for (size_t i = 0; i < original.left.size(); ++i)
    EXPECT_EQ(original.left[i].id, mirrored.right[i].id);
}

TEST(BoundaryEstimator, TurnedWorldTurnsThePath) {
  const std::vector<MapCone> cones = BendingLane();
  const Pose2 pose{1.0, 0.2, 0.1};
  const TrackEstimate original = Estimate(cones, pose);
  for (const double angle : {0.7, 2.5, -1.9}) {
    const Pose2 T_turned_local{120.0, -45.0, angle};
    std::vector<MapCone> turned = cones;
    for (MapCone& cone : turned) cone.position = T_turned_local * cone.position;
    const TrackEstimate estimate = Estimate(turned, T_turned_local * pose);
    ASSERT_EQ(estimate.path.points.size(), original.path.points.size());
    for (size_t i = 0; i < original.path.points.size(); ++i) {
      EXPECT_LT(
          (estimate.path.points[i].position - T_turned_local * original.path.points[i].position)
              .norm(),
          1e-6);
    }
  }
}

TEST(BoundaryEstimator, OrderOfConesDoesNotMatter) {
  std::vector<MapCone> cones = BendingLane();
  const TrackEstimate original = Estimate(cones);
  std::mt19937 random(1);
  for (int round = 0; round < 10; ++round) {
    std::shuffle(cones.begin(), cones.end(), random);
    const TrackEstimate shuffled = Estimate(cones);
    ASSERT_EQ(shuffled.path.points.size(), original.path.points.size());
    for (size_t i = 0; i < original.path.points.size(); ++i) {
      EXPECT_EQ(shuffled.path.points[i].position, original.path.points[i].position);
    }
    EXPECT_EQ(shuffled.winner.log_posterior(), original.winner.log_posterior());
  }
}

TEST(BoundaryEstimator, HasNoPathWithoutCones) {
  const TrackEstimate estimate = Estimate({});
  EXPECT_FALSE(estimate.valid);
  EXPECT_TRUE(estimate.path.points.empty());
  EXPECT_TRUE(estimate.left.empty() && estimate.right.empty());
}

TEST(BoundaryEstimator, WithoutColoursLetsGeometryDecide) {
  const test::SyntheticTrack track = test::MakeLane({{12.0}, {20.0, 0.1}});
  std::vector<MapCone> cones = ConesOf(track);
  WithoutColour(cones);
  const TrackEstimate estimate = Estimate(cones, {1.0, 0.0, 0.0});
  ASSERT_TRUE(estimate.valid);
  EXPECT_EQ(estimate.fallback, Fallback::kColourBlind);
  EXPECT_GE(test::LengthInside(estimate.path.points, track), 15.0);
}

TEST(BoundaryEstimator, FollowsOneSideWhereTheOtherIsMissing) {
  const test::SyntheticTrack track = test::MakeLane({{12.0}, {20.0, 0.1}});
  for (const ConeColour missing : {ConeColour::kBlue, ConeColour::kYellow}) {
    std::vector<MapCone> cones = ConesOf(track);
    std::erase_if(cones, [&](const MapCone& cone) { return MostProbable(cone.colour) == missing; });
    const TrackEstimate estimate = Estimate(cones, {1.0, 0.0, 0.0});
    ASSERT_TRUE(estimate.valid);
    EXPECT_EQ(estimate.fallback, Fallback::kOneSided);
    EXPECT_GE(estimate.path.seen_length, 12.0);
    EXPECT_LT(LargestOffset(estimate.path, track.centre, 12.0), 0.4);
    const auto& inferred = missing == ConeColour::kBlue ? estimate.left : estimate.right;
    for (const BoundaryPoint& point : inferred) EXPECT_EQ(point.id, 0);
  }
}

// A right-hand bend of 14 m radius of which the left cones are known, the right ones up to the car
// only.
TEST(BoundaryEstimator, FollowsOneSideWhereTwoWouldContradictTheColours) {
  const test::SyntheticTrack track = test::MakeLane({{10.0}, {30.0, -1.0 / 14.0}});
  for (double along = 8.0; along < 22.0; along += 1.0) {
    const size_t at = static_cast<size_t>(10.0 * along);
    const Eigen::Vector2d forward = (track.centre[at + 1] - track.centre[at]).normalized();
    const Pose2 pose{track.centre[at].x(), track.centre[at].y(),
                     std::atan2(forward.y(), forward.x())};
    std::vector<MapCone> cones = ConesOf(track);
    std::erase_if(cones, [&](const MapCone& cone) {
      return MostProbable(cone.colour) == ConeColour::kYellow &&
             (pose.Inverse() * cone.position).x() > 0.0;
    });
    const TrackEstimate estimate = Estimate(cones, pose);
    ASSERT_TRUE(estimate.valid);
    EXPECT_GE(estimate.path.seen_length, 10.0) << along;
    EXPECT_LT(LargestOffset(estimate.path, track.centre, 10.0), 1.0) << along;
  }
}

TEST(BoundaryEstimator, DoesNotGiveTwoSidesUpForALongerOne) {
  const test::SyntheticTrack track = test::MakeLane({{8.0}, {9.1, 1.0 / 2.9}, {20.0}}, 3.2, 3.0);
  std::vector<MapCone> cones = ConesOf(track);
  const auto beyond = [](const MapCone& cone) {
    return MostProbable(cone.colour) == ConeColour::kBlue && cone.position.y() > 3.0;
  };
  std::erase_if(cones, beyond);
  const TrackEstimate estimate = Estimate(cones, {2.0, 0.0, 0.0});
  ASSERT_TRUE(estimate.valid);
  EXPECT_EQ(estimate.fallback, Fallback::kNone);
  EXPECT_NE(estimate.left.front().id, 0);
}

TEST(BoundaryEstimator, OffsetsTheOneSidedPathByTheWidthSeenSoFar) {
  const test::SyntheticTrack track = test::MakeLane({{40.0}}, 4.4);
  BoundaryEstimator estimator(ShippedParams());
  std::vector<MapCone> cones = ConesOf(track);
  ASSERT_TRUE(estimator.Estimate({1.0, 0.0, 0.0}, cones).valid);
  std::erase_if(
      cones, [](const MapCone& cone) { return MostProbable(cone.colour) == ConeColour::kYellow; });
  const TrackEstimate estimate = estimator.Estimate({2.0, 0.0, 0.0}, cones);
  ASSERT_TRUE(estimate.valid);
  EXPECT_LT(LargestOffset(estimate.path, track.centre, 12.0), 0.1);
}

TEST(BoundaryEstimator, MarksWhatLiesPastTheLastConeAsExtrapolated) {
  const TrackEstimate estimate = Estimate(ConesOf(test::MakeLane({{9.0}})), {0.0, 0.0, 0.0});
  ASSERT_TRUE(estimate.valid);
  EXPECT_LT(estimate.path.seen_length, 9.5);
  EXPECT_GT(estimate.path.length, estimate.path.seen_length + 1.0);
  for (const PathPoint& point : estimate.path.points) {
    EXPECT_EQ(point.extrapolated, point.position.x() > estimate.path.seen_length + 1e-9);
  }
}

TEST(BoundaryEstimator, StartsBeforeTheGateWithNothingBehind) {
  std::vector<MapCone> cones = ConesOf(test::MakeLane({{20.0}}));
  int64_t id = 100;
  for (const double x : {6.0, 6.4}) {
    for (const double y : {1.7, -1.7}) cones.push_back(Cone(id++, x, y, ConeColour::kOrangeLarge));
  }
  const TrackEstimate estimate = Estimate(cones, {-4.0, 0.1, 0.0});
  ASSERT_TRUE(estimate.valid);
  EXPECT_GE(estimate.path.seen_length, 15.0);
  for (const PathPoint& point : estimate.path.points) EXPECT_LT(std::abs(point.position.y()), 0.7);
}

TEST(BoundaryEstimator, StaysInsideWhenTheCarStandsAskew) {
  const test::SyntheticTrack track = test::MakeLane({{25.0}});
  for (const double yaw : {-0.8, -0.4, 0.4, 0.8}) {
    const TrackEstimate estimate = Estimate(ConesOf(track), {4.0, 0.5, yaw});
    ASSERT_TRUE(estimate.valid);
    EXPECT_GE(estimate.path.seen_length, 14.0);
    EXPECT_GE(test::LengthInside(estimate.path.points, track), estimate.path.seen_length - 1e-9);
  }
}

TEST(BoundaryEstimator, IgnoresConesItDoubts) {
  std::vector<MapCone> cones = BendingLane();
  const TrackEstimate without = Estimate(cones);
  cones.push_back(Cone(999, 6.0, 0.0, ConeColour::kYellow));
  cones.back().existence = 0.2;
  const TrackEstimate with = Estimate(cones);
  ASSERT_EQ(with.path.points.size(), without.path.points.size());
  EXPECT_EQ(with.path.points.back().position, without.path.points.back().position);
}

TEST(BoundaryEstimator, BoundsItsWorkOnFiveHundredPhantoms) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> coordinate(-25.0, 25.0);
  std::vector<MapCone> cones;
  for (int i = 0; i < 500; ++i) {
    cones.push_back(
        Cone(i + 1, coordinate(random), coordinate(random), static_cast<ConeColour>(i % 5)));
  }
  const BoundaryEstimatorParams params = ShippedParams();
  const TrackEstimate estimate = Estimate(cones, {0.0, 0.0, 0.0});
  EXPECT_LE(estimate.num_candidates, 2 * params.search.beam_width * params.search.max_edges + 8);
  EXPECT_LE(estimate.path.length, params.path.max_length + params.path.point_spacing);
  std::set<int64_t> near;
  std::sort(cones.begin(), cones.end(),
            [](const auto& a, const auto& b) { return a.position.norm() < b.position.norm(); });
  for (int i = 0; i < params.max_cones; ++i) near.insert(cones[static_cast<size_t>(i)].id);
  for (const BoundaryPoint& point : estimate.left)
    EXPECT_TRUE(point.id == 0 || near.contains(point.id));
  for (const BoundaryPoint& point : estimate.right)
    EXPECT_TRUE(point.id == 0 || near.contains(point.id));
}

TEST(BoundaryEstimatorParams, AreRefusedOutOfRange) {
  const auto refused = [](const std::function<void(BoundaryEstimatorParams&)>& spoil) {
    BoundaryEstimatorParams params = ShippedParams();
    spoil(params);
    EXPECT_THROW(BoundaryEstimator{params}, std::invalid_argument);
  };
  refused([](auto& p) { p.min_existence = 1.1; });
  refused([](auto& p) { p.near_min_existence = 1.1; });
  refused([](auto& p) { p.near_min_existence = p.min_existence - 0.1; });
  refused([](auto& p) { p.near_range = -1.0; });
  refused([](auto& p) { p.max_range = 0.0; });
  refused([](auto& p) { p.max_cones = 0; });
  refused([](auto& p) { p.max_cones = 129; });
  refused([](auto& p) { p.min_clear_share = -0.1; });
  refused([](auto& p) { p.score.prior_weight = -1.0; });
  refused([](auto& p) { p.search.beam_width = 0; });
  refused([](auto& p) { p.path.point_spacing = 0.0; });
  refused([](auto& p) { p.one_sided.min_spacing = 0.0; });
  refused([](auto& p) { p.one_sided.max_spacing = p.one_sided.min_spacing; });
  refused([](auto& p) { p.one_sided.max_turn = 1.6; });
  refused([](auto& p) { p.one_sided.min_log_ratio = 0.1; });
  refused([](auto& p) { p.one_sided.max_jump = 0.0; });
  refused([](auto& p) { p.one_sided.log_penalty = -1.0; });
  refused([](auto& p) { p.one_sided.default_width = 0.0; });
}

}  // namespace
}  // namespace hairpin
