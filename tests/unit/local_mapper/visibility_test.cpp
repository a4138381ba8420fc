#include "daemons/local_mapper/visibility.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hairpin {
namespace {

constexpr VisibilityParams kParams{
    .bearing_margin = 0.05, .range_margin = 0.5, .occlusion_half_width = 0.2};

Eigen::Vector2d Polar(double range, double bearing) {
  return {range * std::cos(bearing), range * std::sin(bearing)};
}

TEST(RecallByRange, IsLinearBetweenItsPointsAndZeroOutside) {
  const RecallByRange recall{{2.0, 10.0, 20.0}, {0.9, 0.7, 0.1}};
  EXPECT_NEAR(recall.At(6.0), 0.8, 1e-12);
  EXPECT_NEAR(recall.At(15.0), 0.4, 1e-12);
  EXPECT_NEAR(recall.At(2.0), 0.9, 1e-12);
  EXPECT_NEAR(recall.At(20.0), 0.1, 1e-12);
  EXPECT_EQ(recall.At(1.9), 0.0);
  EXPECT_EQ(recall.At(20.1), 0.0);
}

TEST(InView, LeavesAMarginAtTheEdgesOfTheView) {
  const std::vector<ViewSector> sectors{{-1.0, 1.0, 20.0}};
  EXPECT_TRUE(InView(sectors, Polar(10.0, 0.94), kParams));
  EXPECT_FALSE(InView(sectors, Polar(10.0, 0.96), kParams));
  EXPECT_TRUE(InView(sectors, Polar(19.4, 0.0), kParams));
  EXPECT_FALSE(InView(sectors, Polar(19.6, 0.0), kParams));
}

TEST(InView, SeesNoEdgeWhereTwoSectorsMeet) {
  EXPECT_TRUE(InView({{-1.0, 0.0, 20.0}, {0.0, 1.0, 20.0}}, {10.0, 0.0}, kParams));
}

TEST(InView, CoversASectorAcrossTheRear) {
  const std::vector<ViewSector> rear{{2.5, 3.8, 20.0}};
  EXPECT_TRUE(InView(rear, Polar(10.0, 3.1), kParams));
  EXPECT_TRUE(InView(rear, Polar(10.0, -2.7), kParams));
  EXPECT_FALSE(InView(rear, Polar(10.0, 0.0), kParams));
}

TEST(InView, IsEmptyWithoutAWorkingSensor) { EXPECT_FALSE(InView({}, {5.0, 0.0}, kParams)); }

TEST(Occlusion, HidesOnlyWhatStandsBehindAndInLine) {
  const std::vector<Eigen::Vector2d> cones{{5.0, 1.0}};
  EXPECT_TRUE(IsHidden({10.0, 2.1}, cones, kParams));
  EXPECT_FALSE(IsHidden({10.0, 3.0}, cones, kParams));
  EXPECT_FALSE(IsHidden({2.5, 0.5}, cones, kParams));     // in front of it
  EXPECT_FALSE(IsHidden({-10.0, -2.0}, cones, kParams));  // opposite
  EXPECT_FALSE(IsHidden({5.0, 1.0}, cones, kParams));     // the cone itself
}

}  // namespace
}  // namespace hairpin
