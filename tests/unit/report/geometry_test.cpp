#include <gtest/gtest.h>

#include <random>

#include "tests/support/synthetic_run.hpp"
#include "tools/report/map_comparison.hpp"
#include "tools/report/trajectory.hpp"
#include "tools/report/true_track.hpp"
#include "tools/report/view.hpp"

namespace hairpin {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points RandomPoints(int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-40.0, 40.0);
  Points points;
  for (int i = 0; i < count; ++i) points.emplace_back(uniform(random), uniform(random));
  return points;
}

TEST(AlignRigidly, FindsTheTransformExactly) {
  const Points from = RandomPoints(20);
  for (const double yaw : {0.0, 0.3, -2.0, std::numbers::pi}) {
    const Pose2 T_to_from{3.0, -7.0, yaw};
    Points to;
    for (const auto& point : from) to.push_back(T_to_from * point);
    const auto found = AlignRigidly(from, to);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->x, T_to_from.x, 1e-9);
    EXPECT_NEAR(found->y, T_to_from.y, 1e-9);
    EXPECT_NEAR(WrapAngle(found->yaw - yaw), 0.0, 1e-9);
  }
}

TEST(AlignRigidly, HasNoAnswerForTooLittle) {
  EXPECT_FALSE(AlignRigidly({}, {}));
  EXPECT_FALSE(AlignRigidly({{1.0, 2.0}}, {{1.0, 2.0}}));
  EXPECT_FALSE(AlignRigidly({{1.0, 2.0}, {1.0, 2.0}}, {{1.0, 2.0}, {3.0, 2.0}}));
  EXPECT_THROW(AlignRigidly({{1.0, 2.0}}, {}), std::invalid_argument);
}

TEST(AlignByIcp, RecoversFromAGuessOfAMetreAndTwoDegrees) {
  const RunLog run = MakeSyntheticRun({});
  Points truth;
  for (const TrueCone& cone : TrueCones(*run.truth_track)) truth.push_back(cone.position);
  const Pose2 T_map_local{5.0, -3.0, 0.7};
  Points local;
  for (const auto& point : truth) local.push_back(T_map_local.Inverse() * point);
  const Pose2 guess = Pose2{0.6, -0.8, 0.035} * T_map_local;
  const Pose2 found = AlignByIcp(local, truth, guess);
  EXPECT_NEAR(found.x, T_map_local.x, 1e-6);
  EXPECT_NEAR(found.y, T_map_local.y, 1e-6);
  EXPECT_NEAR(found.yaw, T_map_local.yaw, 1e-6);
}

TEST(AlignByIcp, KeepsTheGuessWhereThereIsNothingToAlign) {
  const Pose2 guess{1.0, 2.0, 0.5};
  const Pose2 found = AlignByIcp({}, {{0.0, 0.0}}, guess);
  EXPECT_EQ(found.x, guess.x);
  EXPECT_EQ(found.yaw, guess.yaw);
}

/// Straight along x, 3 m wide.
truth_track_t StraightTrack() {
  truth_track_t track{};
  track.closed = false;
  for (int i = 0; i <= 10; ++i) {
    track.left.push_back({5.0 * i, 1.5, cone_observation_t::BLUE});
    track.right.push_back({5.0 * i, -1.5, cone_observation_t::YELLOW});
  }
  return track;
}

TEST(TrackBand, OfAnOpenTrackGoesOnPastItsEnds) {
  const TrackBand band(StraightTrack());
  for (const double x : {-29.0, -1.0, 0.0, 25.0, 50.0, 79.0}) {
    EXPECT_TRUE(band.Contains({x, 1.4})) << x;
    EXPECT_TRUE(band.Contains({x, -1.4})) << x;
    EXPECT_FALSE(band.Contains({x, 1.6})) << x;
    EXPECT_FALSE(band.Contains({x, -1.6})) << x;
  }
  EXPECT_FALSE(band.Contains({-31.0, 0.0}));
  EXPECT_FALSE(band.Contains({81.0, 0.0}));
}

TEST(TrackBand, OfAClosedTrackIsTheRingEitherWayRound) {
  SyntheticRun oval({});
  truth_track_t track = *oval.Make().truth_track;
  truth_track_t reversed = track;
  std::swap(reversed.left, reversed.right);
  std::reverse(reversed.left.begin(), reversed.left.end());
  std::reverse(reversed.right.begin(), reversed.right.end());
  for (const auto& each : {track, reversed}) {
    const TrackBand band(each);
    for (double s = 0.0; s < oval.perimeter(); s += 1.0) {
      EXPECT_TRUE(band.Contains(oval.Middle(s).position()));
      for (const double beside : {-2.2, 2.2, 10.0, -10.0}) {
        EXPECT_FALSE(band.Contains(oval.Middle(s) * Eigen::Vector2d(0.0, beside)))
            << s << " " << beside;
      }
    }
  }
}

TEST(TrackBand, HoldsWhereATrackCrossesItself) {
  truth_track_t track{};  // a figure of eight
  track.closed = true;
  for (int i = 0; i < 400; ++i) {
    const double t = 2.0 * std::numbers::pi * i / 400;
    const Eigen::Vector2d middle(30.0 * std::sin(t), 15.0 * std::sin(2.0 * t));
    const Eigen::Vector2d ahead(30.0 * std::cos(t), 30.0 * std::cos(2.0 * t));
    const Eigen::Vector2d left = 1.5 * Eigen::Vector2d(-ahead.y(), ahead.x()).normalized();
    track.left.push_back({(middle + left).x(), (middle + left).y(), cone_observation_t::BLUE});
    track.right.push_back({(middle - left).x(), (middle - left).y(), cone_observation_t::YELLOW});
  }
  const TrackBand band(track);
  EXPECT_TRUE(band.Contains({0.0, 0.0}));
  EXPECT_TRUE(band.Contains({30.0, 0.0}));
  EXPECT_FALSE(band.Contains({15.0, 0.0}));
  EXPECT_FALSE(band.Contains({-15.0, 0.0}));
  EXPECT_FALSE(band.Contains({0.0, 10.0}));
}

TEST(TrueCones, LeavesClutterOutAndTakesEachConeOnce) {
  truth_track_t track = StraightTrack();
  track.cones = track.left;
  track.cones.push_back({7.0, 7.0, cone_observation_t::UNKNOWN});
  track.cones.push_back({0.0, 2.0, cone_observation_t::ORANGE_LARGE});
  EXPECT_EQ(TrueCones(track).size(), 11u + 11u + 1u);
  ASSERT_EQ(Clutter(track).size(), 1u);
  EXPECT_EQ(Clutter(track)[0], Eigen::Vector2d(7.0, 7.0));
}

TEST(TrueTrajectory, InterpolatesAcrossTheTurnOfTheAngleAndRefusesGaps) {
  RunLog log;
  for (const auto& [utime, x, yaw] :
       {std::tuple{0, 0.0, 3.1}, {100'000, 1.0, -3.1}, {900'000, 2.0, 0.0}}) {
    truth_t truth{};
    truth.utime = utime;
    truth.x_m = x;
    truth.yaw_rad = yaw;
    log.truth.push_back(truth);
  }
  const TrueTrajectory trajectory(log);
  const auto state = trajectory.At(50'000);
  ASSERT_TRUE(state);
  EXPECT_NEAR(state->T_map_base.x, 0.5, 1e-12);
  EXPECT_NEAR(std::abs(state->T_map_base.yaw), std::numbers::pi, 1e-9);
  EXPECT_TRUE(trajectory.At(900'000));
  EXPECT_FALSE(trajectory.At(500'000));
  EXPECT_FALSE(trajectory.At(-1));
  EXPECT_FALSE(trajectory.At(900'001));
}

TEST(View, KeepsHandednessAndShapeAndIsWiderThanHigh) {
  for (const Points& points :
       {Points{{0.0, 0.0}, {80.0, 30.0}}, Points{{0.0, 0.0}, {30.0, 80.0}}}) {
    const View view(points);
    const Eigen::Vector2d origin = view({10.0, 10.0});
    const Eigen::Vector2d x = view({11.0, 10.0}) - origin;
    const Eigen::Vector2d y = view({10.0, 11.0}) - origin;
    EXPECT_NEAR(x.x() * y.y() - x.y() * y.x(), -view.scale() * view.scale(),
                1e-9);  // y is down in a picture
    EXPECT_NEAR(x.dot(y), 0.0, 1e-9);
    const Eigen::Vector2d size = (view(points[1]) - view(points[0])).cwiseAbs();
    EXPECT_GT(size.x(), size.y());
    EXPECT_LT(size.x(), View::kWidth);
    EXPECT_LT(size.y(), view.height());
  }
}

}  // namespace
}  // namespace hairpin
