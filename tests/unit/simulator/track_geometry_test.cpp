#include "tools/simulator/track_geometry.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/unit/simulator/track_testing.hpp"

namespace hairpin {
namespace {

const Polyline kSquare{{0, 0}, {4, 0}, {4, 4}, {0, 4}};

TEST(TrackGeometry, LengthCountsTheClosingSegmentOnlyOfClosedLines) {
  EXPECT_DOUBLE_EQ(Length(kSquare, false), 12.0);
  EXPECT_DOUBLE_EQ(Length(kSquare, true), 16.0);
}

TEST(TrackGeometry, NearestFindsSegmentFractionAndDistance) {
  const PolylinePoint near = Nearest(kSquare, true, {-1.0, 3.0});
  EXPECT_EQ(near.segment, 3u);
  EXPECT_DOUBLE_EQ(near.fraction, 0.25);
  EXPECT_DOUBLE_EQ(near.distance, 1.0);
  EXPECT_EQ(Nearest(kSquare, false, {-1.0, 2.5}).segment, 2u);
}

TEST(TrackGeometry, SegmentsMeetWhereTheyCrossTouchOrOverlap) {
  EXPECT_TRUE(SegmentsMeet({0, 0}, {2, 2}, {0, 2}, {2, 0}));
  EXPECT_TRUE(SegmentsMeet({0, 0}, {2, 0}, {1, 0}, {1, 5}));
  EXPECT_TRUE(SegmentsMeet({0, 0}, {2, 0}, {1, 0}, {3, 0}));
  EXPECT_FALSE(SegmentsMeet({0, 0}, {2, 0}, {3, 0}, {4, 0}));
  EXPECT_FALSE(SegmentsMeet({0, 0}, {2, 0}, {0, 1}, {2, 1}));
  EXPECT_FALSE(SegmentsMeet({0, 0}, {1, 1}, {0, 3}, {3, 0}));
}

TEST(TrackGeometry, ResampledPointsAreEvenlySpacedAndKeepTheEnds) {
  const Polyline points = Resampled({{0, 0}, {3, 0}, {3, 1}}, 0.6);
  ASSERT_EQ(points.size(), 8u);
  EXPECT_EQ(points.front(), Eigen::Vector2d(0, 0));
  EXPECT_EQ(points.back(), Eigen::Vector2d(3, 1));
  EXPECT_NEAR((points[3] - points[2]).norm(), 4.0 / 7.0, 1e-12);
}

TEST(TrackGeometry, CentreLineOfAnOvalIsTheOval) {
  const Track track = LoadTrack(Fixture("oval_hairpin.yaml"));
  const Polyline centre = CentreLine(track);
  EXPECT_LT((centre.front() - Eigen::Vector2d(6.0, 0.0)).norm(), 1e-9);
  EXPECT_LT((centre.back() - centre.front()).norm(), 1e-9);
  EXPECT_NEAR(Length(centre, false), 40.0 + 2.0 * std::numbers::pi * 8.0,
              1.5);  // of chords, not arcs
  for (const Eigen::Vector2d& point : centre) {
    const double x = std::max(0.0, std::abs(point.x()) - 10.0);
    EXPECT_NEAR(std::hypot(x, point.y() - 8.0), 8.0, 0.5) << point.transpose();
  }
}

TEST(TrackGeometry, CentreLineLeadsOnFromTheStart) {
  const Track track = LoadTrack(Fixture("oval_hairpin.yaml"));
  const Polyline centre = CentreLine(track);
  EXPECT_GT(centre[4].x(), centre[0].x());
  for (const CrossSection& section : CrossSections(track, 0.5))
    EXPECT_NEAR(section.width(), 4.0, 0.5);
}

TEST(TrackGeometry, OnTrackIsBetweenTheSides) {
  const Track lap = LoadTrack(Fixture("oval_hairpin.yaml"));
  EXPECT_TRUE(IsOnTrack(lap, {0.0, 0.0}));
  EXPECT_TRUE(IsOnTrack(lap, {17.5, 8.0}));
  EXPECT_FALSE(IsOnTrack(lap, {0.0, 8.0}));
  EXPECT_FALSE(IsOnTrack(lap, {0.0, -3.0}));
  const Track strip = LoadTrack(Fixture("strip_pacsim.yaml"));
  EXPECT_TRUE(IsOnTrack(strip, {-5.0, 1.0}));  // before the first cones, where the car waits
  EXPECT_FALSE(IsOnTrack(strip, {-11.0, 0.0}));
  EXPECT_FALSE(IsOnTrack(strip, {10.0, 2.5}));
}

}  // namespace
}  // namespace hairpin
