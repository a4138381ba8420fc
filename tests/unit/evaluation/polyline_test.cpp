#include "tools/evaluation/polyline.hpp"

#include <gmock/gmock.h>

namespace hairpin {
namespace {

TEST(Intersect, TellsCrossingFromPassing) {
  const Segment along{{0.0, 0.0}, {2.0, 0.0}};
  EXPECT_TRUE(Intersect(along, {{1.0, -1.0}, {1.0, 1.0}}));
  EXPECT_TRUE(Intersect(along, {{1.0, 0.0}, {1.0, 1.0}}));
  EXPECT_TRUE(Intersect(along, {{1.0, 0.0}, {3.0, 0.0}}));
  EXPECT_FALSE(Intersect(along, {{1.0, 0.1}, {1.0, 1.0}}));
  EXPECT_FALSE(Intersect(along, {{3.0, -1.0}, {3.0, 1.0}}));
  EXPECT_FALSE(Intersect(along, {{3.0, 0.0}, {4.0, 0.0}}));
}

TEST(Polyline, IsClippedAtALength) {
  const Polyline line{{0.0, 0.0}, {3.0, 0.0}, {3.0, 4.0}};
  EXPECT_EQ(Length(line), 7.0);
  EXPECT_THAT(Clipped(line, 5.0),
              testing::ElementsAre(line[0], line[1], Eigen::Vector2d(3.0, 2.0)));
  EXPECT_EQ(Clipped(line, 9.0), line);
  EXPECT_EQ(PointAt(line, 1.5), Eigen::Vector2d(1.5, 0.0));
  EXPECT_EQ(PointAt(line, 8.0), line[2]);
  EXPECT_THROW(PointAt({}, 1.0), std::invalid_argument);
}

TEST(Project, FindsTheNearestPoint) {
  const Polyline line{{0.0, 0.0}, {3.0, 0.0}, {3.0, 4.0}};
  const Projection beside = Project({4.0, 1.0}, line);
  EXPECT_DOUBLE_EQ(beside.distance, 1.0);
  EXPECT_DOUBLE_EQ(beside.along, 4.0);
  EXPECT_DOUBLE_EQ(Project({-3.0, 4.0}, line).distance, 5.0);
  EXPECT_THROW(Project({0.0, 0.0}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
