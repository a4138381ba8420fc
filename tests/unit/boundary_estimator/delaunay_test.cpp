#include "daemons/boundary_estimator/delaunay.hpp"

#include <gmock/gmock.h>

#include <random>

namespace hairpin {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

TEST(Triangulate, GivesNothingForPointsOnALine) {
  EXPECT_TRUE(Triangulate({}).triangles.empty());
  EXPECT_TRUE(Triangulate({{0.0, 0.0}, {1.0, 1.0}}).triangles.empty());
  EXPECT_TRUE(Triangulate({{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}}).triangles.empty());
}

TEST(Triangulate, LeavesCoincidingPointsOut) {
  const Triangulation result = Triangulate({{0.0, 0.0}, {0.0, 0.0}, {2.0, 0.0}, {0.0, 2.0}});
  ASSERT_EQ(result.triangles.size(), 1U);
  EXPECT_THAT(result.triangles[0].vertex, testing::UnorderedElementsAre(0, 2, 3));
  EXPECT_THAT(result.triangles[0].neighbour, testing::Each(Triangulation::kOutside));
}

TEST(Triangulate, HasEmptyCircumcirclesAndMutualNeighbours) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-20.0, 20.0);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 60; ++i) points.emplace_back(coordinate(random), coordinate(random));
  const Triangulation result = Triangulate(points);
  ASSERT_GT(result.triangles.size(), 80U);
  for (size_t t = 0; t < result.triangles.size(); ++t) {
    const auto& [vertex, neighbour] = result.triangles[t];
    const auto corner = [&, v = vertex](size_t i) { return points[static_cast<size_t>(v[i % 3])]; };
    EXPECT_GT(Cross(corner(1) - corner(0), corner(2) - corner(0)), 0.0);
    for (const Eigen::Vector2d& point : points) {
      Eigen::Matrix3d in_circle;
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector2d d = corner(static_cast<size_t>(i)) - point;
        in_circle.row(i) << d.x(), d.y(), d.squaredNorm();
      }
      const double det =
          in_circle(0, 0) *
              (in_circle(1, 1) * in_circle(2, 2) - in_circle(1, 2) * in_circle(2, 1)) -
          in_circle(0, 1) *
              (in_circle(1, 0) * in_circle(2, 2) - in_circle(1, 2) * in_circle(2, 0)) +
          in_circle(0, 2) * (in_circle(1, 0) * in_circle(2, 1) - in_circle(1, 1) * in_circle(2, 0));
      EXPECT_LE(det, 1e-6);
    }
    for (const int other : neighbour) {
      if (other == Triangulation::kOutside) continue;
      EXPECT_THAT(result.triangles[static_cast<size_t>(other)].neighbour,
                  testing::Contains(static_cast<int>(t)));
    }
  }
}

}  // namespace
}  // namespace hairpin
