#include "daemons/boundary_estimator/one_sided.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "daemons/boundary_estimator/boundary_estimator.hpp"
#include "tests/unit/boundary_estimator/shipped_params.hpp"

namespace hairpin {
namespace {

using test::Cone;
using test::ShippedParams;

constexpr SideLogRatios kSurelyLeft{0.0, -4.6};
constexpr SideLogRatios kSurelyRight{-4.6, 0.0};

// A straight lane, 3 m wide: cones 0 and 1 stand left at 5 and 10 m, 2 and 3 right at 6 and 11 m.
Scene Straight() {
  return {{1, 2, 3, 4},
          {{5.0, 1.5}, {10.0, 1.5}, {6.0, -1.5}, {11.0, -1.5}},
          {kSurelyLeft, kSurelyLeft, kSurelyRight, kSurelyRight}};
}

Stretch Through(const Scene& scene, const std::vector<CrossedEdge>& edges) {
  Stretch stretch;
  for (const CrossedEdge& edge : edges) {
    stretch.Append(edge, {scene.positions[static_cast<size_t>(edge.left)],
                          scene.positions[static_cast<size_t>(edge.right)]});
  }
  return stretch;
}

Stretch Continued(const Scene& scene, const std::vector<CrossedEdge>& edges) {
  Stretch stretch = Through(scene, edges);
  ContinueOnOneSide(scene, 3.0, ShippedParams().one_sided, stretch);
  return stretch;
}

TEST(ContinueOnOneSide, LeadsOnToTheLastConeOfTheSideThatReachesFarther) {
  const Scene scene = Straight();
  const Stretch stretch = Continued(scene, {{0, 2}, {1, 2}});
  ASSERT_EQ(stretch.size(), 3U);
  EXPECT_EQ(stretch.edges.back(), (CrossedEdge{CrossedEdge::kInferred, 3}));
  EXPECT_NEAR(stretch.end().x(), 11.0, 1e-9);
  EXPECT_NEAR(stretch.end().y(), 0.0, 1e-9);
}

TEST(ContinueOnOneSide, EndsSquareAtTheConeThatStandsAheadOfItsOpposite) {
  Scene scene = Straight();
  scene.positions[1].x() = 14.0;
  const Stretch stretch = Continued(scene, {{0, 2}, {0, 3}, {1, 3}});
  ASSERT_EQ(stretch.size(), 4U);
  EXPECT_EQ(stretch.edges.back(), (CrossedEdge{1, CrossedEdge::kInferred}));
  EXPECT_NEAR(stretch.end().x(), 14.0, 1e-9);
  EXPECT_NEAR(stretch.end().y(), 0.0, 1e-9);
  EXPECT_NEAR(stretch.gates.back().width(), 3.0, 1e-9);
}

TEST(ContinueOnOneSide, AddsNothingToAStretchThatEndsSquare) {
  Scene scene = Straight();
  scene.positions[3].x() = 10.0;
  EXPECT_EQ(Continued(scene, {{0, 2}, {1, 2}, {1, 3}}).size(), 3U);
}

// The cones about a car that has lost the left one beside it: the best path of the tree squeezes
// through a sliver of three right cones.
TEST(BoundaryEstimator, TakesNoWidthFromAPathThroughASliver) {
  BoundaryEstimator estimator(ShippedParams());
  const std::vector<MapCone> cones = {
      Cone(80, -0.5, 1.8, ConeColour::kBlue),    Cone(83, -1.9, 5.7, ConeColour::kBlue),
      Cone(84, -0.1, -1.8, ConeColour::kYellow), Cone(85, 2.7, 9.2, ConeColour::kYellow),
      Cone(87, 2.9, 5.7, ConeColour::kBlue),     Cone(92, 9.9, -1.5, ConeColour::kYellow),
      Cone(93, 5.0, -1.6, ConeColour::kYellow),  Cone(94, 9.4, 1.8, ConeColour::kBlue),
      Cone(95, 8.2, 6.0, ConeColour::kBlue),     Cone(97, 14.5, 2.3, ConeColour::kBlue),
      Cone(99, 12.7, 9.6, ConeColour::kYellow),  Cone(103, 13.1, 6.1, ConeColour::kBlue),
      Cone(105, 14.9, -1.2, ConeColour::kYellow)};
  const TrackEstimate estimate = estimator.Estimate(Pose2{}, cones);
  ASSERT_TRUE(estimate.valid);
  for (const PathPoint& point : estimate.path.points) {
    EXPECT_LT(std::abs(point.position.y()), 0.8) << point.position.x();
  }
}

}  // namespace
}  // namespace hairpin
