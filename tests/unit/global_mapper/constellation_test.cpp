#include "daemons/global_mapper/constellation.hpp"

#include <gtest/gtest.h>

namespace hairpin {
namespace {

ConstellationParams Params() { return {0.5, 12.0, 0.35, 6, 3}; }

/// Two sides of a bend, with the orange gate at its beginning.
std::vector<ConstellationPoint> Bend() {
  std::vector<ConstellationPoint> points;
  for (const double x : {0.0, 0.7}) {
    points.push_back({{x, 2.0}, ConeColour::kOrangeLarge});
    points.push_back({{x, -2.0}, ConeColour::kOrangeLarge});
  }
  for (int i = 1; i <= 4; ++i) {
    const double x = 4.0 * i;
    points.push_back({{x, 2.0 + 0.04 * x * x}, ConeColour::kBlue});
    points.push_back({{x + 0.8, -2.0 + 0.03 * x * x}, ConeColour::kYellow});
  }
  return points;
}

std::vector<ConstellationPoint> Moved(const std::vector<ConstellationPoint>& points,
                                      const Pose2& T) {
  std::vector<ConstellationPoint> moved;
  for (const ConstellationPoint& point : points)
    moved.push_back({T * point.position, point.colour});
  return moved;
}

TEST(Constellation, IsFoundUnderADriftOfMoreThanTheConeSpacing) {
  const Pose2 drift{5.0, -6.0, 0.1};
  const auto match = MatchConstellation(Moved(Bend(), drift), Bend(), {}, Params());
  ASSERT_TRUE(match);
  EXPECT_EQ(match->pairs.size(), Bend().size());
  EXPECT_NEAR((match->T_to_from * drift).position().norm(), 0.0, 1e-6);
  for (const auto& [from, to] : match->pairs) EXPECT_EQ(from, to);
}

TEST(Constellation, OfEquallySpacedConesIsRefusedSinceItFitsInMoreThanOnePlace) {
  std::vector<ConstellationPoint> straight;
  for (int i = 0; i < 8; ++i) {
    straight.push_back({{4.0 * i, 2.0}, ConeColour::kBlue});
    straight.push_back({{4.0 * i, -2.0}, ConeColour::kYellow});
  }
  const std::vector<ConstellationPoint> part(straight.begin() + 4, straight.begin() + 12);
  EXPECT_FALSE(MatchConstellation(Moved(part, {1.8, 0.0, 0.0}), straight, {}, Params()));
}

TEST(Constellation, WithTheColoursSwappedIsAnotherOne) {
  auto swapped = Bend();
  for (ConstellationPoint& point : swapped) {
    if (point.colour == ConeColour::kBlue) {
      point.colour = ConeColour::kYellow;
    } else if (point.colour == ConeColour::kYellow) {
      point.colour = ConeColour::kBlue;
    }
  }
  EXPECT_FALSE(MatchConstellation(swapped, Bend(), {}, Params()));
}

// A LiDAR's colours, where one cone is seen from afar and from near.
TEST(Constellation, IsFoundThoughSomeColoursAreWrongWhereThoseCountLess) {
  auto wrong = Bend();
  wrong[4].colour = ConeColour::kYellow;
  wrong[7].colour = ConeColour::kBlue;
  ConstellationParams params = Params();
  params.contradiction_weight = 0.5;
  const Pose2 drift{5.0, -6.0, 0.1};
  const auto match = MatchConstellation(Moved(wrong, drift), Bend(), {}, params);
  ASSERT_TRUE(match);
  EXPECT_EQ(match->pairs.size(), Bend().size());
  EXPECT_NEAR(match->score, static_cast<double>(Bend().size()) - 1.0, 1e-6);
  EXPECT_LT(MatchConstellation(Moved(wrong, drift), Bend(), {}, Params())->pairs.size(),
            Bend().size());
}

TEST(Constellation, BeyondTheBoundsIsNotLookedFor) {
  EXPECT_FALSE(MatchConstellation(Moved(Bend(), {20.0, 0.0, 0.0}), Bend(), {}, Params()));
}

TEST(Constellation, OfTooFewConesIsNone) {
  auto few = Bend();
  few.resize(5);
  EXPECT_FALSE(MatchConstellation(few, Bend(), {}, Params()));
}

TEST(ConstellationParams, AreChecked) {
  ConstellationParams params = Params();
  params.min_pairs = 2;
  EXPECT_THROW(params.Validate(), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
