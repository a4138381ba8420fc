#include "daemons/path_tracker/reference_path.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>
#include <stdexcept>

#include "tests/unit/path_tracker/closed_loop.hpp"

namespace hairpin {
namespace {

using test::PathBuilder;
using test::Points;

constexpr ReferencePathParams kParams{.spacing = 0.5, .smoothing_length = 1.2, .max_length = 30.0};

Points Circle(double radius, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  Points points;
  for (int i = 0; i <= 24; ++i) {
    const double angle = 0.5 * i / radius;
    points.emplace_back(radius * std::sin(angle) + noise * normal(random),
                        radius * (1.0 - std::cos(angle)) + noise * normal(random));
  }
  return points;
}

TEST(ReferencePath, OfAStraightLineIsTheLine) {
  const ReferencePath path({{1.0, 2.0}, {4.0, 6.0}, {7.0, 10.0}}, kParams);
  EXPECT_NEAR(path.length(), 10.0, 1e-9);
  const auto location = path.Locate({4.0 - 0.8, 6.0 + 0.6}, 0.0, 10.0);
  EXPECT_NEAR(location.s, 5.0, 1e-9);
  EXPECT_NEAR(location.lateral_error, 1.0, 1e-9);
  EXPECT_NEAR(location.heading, std::atan2(4.0, 3.0), 1e-9);
  EXPECT_NEAR(location.curvature, 0.0, 1e-9);
}

TEST(ReferencePath, GoesOnStraightBeforeItsStartAndPastItsEnd) {
  const ReferencePath path({{0.0, 0.0}, {10.0, 0.0}}, kParams);
  EXPECT_NEAR(path.Locate({-2.0, 1.0}, -5.0, 5.0).s, -2.0, 1e-9);
  EXPECT_NEAR(path.Locate({13.0, -1.0}, 5.0, 20.0).s, 13.0, 1e-9);
  EXPECT_NEAR(path.Locate({13.0, -1.0}, 5.0, 20.0).lateral_error, -1.0, 1e-9);
}

// Greatest relative error of the curvature of a circle, leaving out `margin` metres at both ends.
double CurvatureError(double radius, double margin) {
  const ReferencePath path(Circle(radius, 0.0, 1), kParams);
  double most = 0.0;
  for (double s = margin; s <= path.length() - margin; s += 0.1) {
    const double angle = s / radius;
    const Eigen::Vector2d point(radius * std::sin(angle), radius * (1.0 - std::cos(angle)));
    const auto location = path.Locate(point, s - 1.0, s + 1.0);
    EXPECT_NEAR(location.lateral_error, 0.0, 0.1) << radius << " " << s;
    most = std::max(most, std::abs(location.curvature * radius - 1.0));
  }
  return most;
}

TEST(ReferencePath, KnowsTheCurvatureOfTurns) {
  EXPECT_LT(CurvatureError(15.0, 0.2), 0.03);
  EXPECT_LT(CurvatureError(9.0, 0.2), 0.08);
  // The tightest hairpin: within a few percent inside, too low at the ends.
  EXPECT_LT(CurvatureError(3.0, 2.0), 0.06);
  EXPECT_LT(CurvatureError(3.0, 0.2), 0.42);
}

TEST(ReferencePath, SmoothsNoiseOfFiveCentimetresToAFewHundredthsOfCurvature) {
  double squared = 0.0;
  double raw = 0.0;
  int n = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Points points = Circle(15.0, 0.05, seed);
    const ReferencePath smooth(points, kParams);
    ReferencePathParams rough = kParams;
    rough.smoothing_length = 0.0;
    const ReferencePath unsmoothed(points, rough);
    for (size_t i = 3; i + 3 < smooth.curvature().size(); ++i, ++n) {
      squared += std::pow(smooth.curvature()[i] - 1.0 / 15.0, 2);
      raw += std::pow(
          unsmoothed.curvature()[std::min(i, unsmoothed.curvature().size() - 1)] - 1.0 / 15.0, 2);
    }
  }
  EXPECT_LT(std::sqrt(squared / n), 0.03);
  EXPECT_LT(squared, 0.02 * raw);
}

TEST(ReferencePath, SmoothingEqualsTheDenseSolutionOfItsNormalEquations) {
  const Points points = Circle(8.0, 0.1, 3);
  ReferencePathParams rough = kParams;
  rough.smoothing_length = 0.0;
  const ReferencePath path(points, kParams);
  // The same minimum by a dense solver, on the same samples.
  const ReferencePath samples(points, rough);
  const auto n = static_cast<Eigen::Index>(samples.curvature().size());
  double length = 0.0;
  for (size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  const double step = length / static_cast<double>(n - 1);
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n - 3, n);
  for (Eigen::Index i = 0; i + 3 < n; ++i) D.block<1, 4>(i, i) << -1.0, 3.0, -3.0, 1.0;
  const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n) +
                            std::pow(kParams.smoothing_length / step, 6) * D.transpose() * D;
  Eigen::MatrixXd p(n, 2);
  double before = 0.0;
  size_t k = 1;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double s = step * static_cast<double>(i);
    while (k + 1 < points.size() && before + (points[k] - points[k - 1]).norm() < s) {
      before += (points[k] - points[k - 1]).norm();
      ++k;
    }
    const double t = std::min((s - before) / (points[k] - points[k - 1]).norm(), 1.0);
    p.row(i) = ((1.0 - t) * points[k - 1] + t * points[k]).transpose();
  }
  const Eigen::MatrixXd q = A.inverse() * p;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double s = step * static_cast<double>(i);
    EXPECT_NEAR(path.Locate(q.row(i).transpose(), s - 2.0, s + 2.0).lateral_error, 0.0, 0.01);
  }
}

TEST(ReferencePath, LooksOnlyWithinTheArcLengthsGiven) {
  // A hairpin whose legs are 6 m apart: a point beside the first leg, nearer to the second.
  const ReferencePath path(
      PathBuilder().Straight(8).Arc(3.0 * std::numbers::pi, 1.0 / 3.0).Straight(8).Build(),
      kParams);
  const auto location = path.Locate({3.0, 3.5}, 0.0, 6.0);
  EXPECT_NEAR(location.s, 3.0, 0.1);
  EXPECT_NEAR(location.lateral_error, 3.5, 0.1);
}

TEST(ReferencePath, TurnsWithTheWorld) {
  const Points points = Circle(6.0, 0.05, 4);
  const Pose2 T_b_a{20.0, -4.0, 2.5};
  Points turned;
  for (const auto& point : points) turned.push_back(T_b_a * point);
  const ReferencePath path(points, kParams);
  const ReferencePath turned_path(turned, kParams);
  const Eigen::Vector2d point(4.0, 1.0);
  const auto a = path.Locate(point, 0.0, 12.0);
  const auto b = turned_path.Locate(T_b_a * point, 0.0, 12.0);
  EXPECT_NEAR(a.s, b.s, 1e-9);
  EXPECT_NEAR(a.lateral_error, b.lateral_error, 1e-9);
  EXPECT_NEAR(a.curvature, b.curvature, 1e-9);
  EXPECT_NEAR(WrapAngle(b.heading - a.heading), 2.5, 1e-9);
}

TEST(ReferencePath, IsCutOffAtItsGreatestLength) {
  EXPECT_NEAR(ReferencePath({{0.0, 0.0}, {100.0, 0.0}}, kParams).length(), 30.0, 1e-9);
}

TEST(ReferencePath, RefusesAPathWithoutLengthAndWrongParameters) {
  EXPECT_THROW(ReferencePath({}, kParams), std::invalid_argument);
  EXPECT_THROW(ReferencePath({{1.0, 1.0}}, kParams), std::invalid_argument);
  EXPECT_THROW(ReferencePath({{1.0, 1.0}, {1.0, 1.0}}, kParams), std::invalid_argument);
  const Points points{{0.0, 0.0}, {5.0, 0.0}};
  EXPECT_THROW(ReferencePath(points, {0.0, 0.9, 30.0}), std::invalid_argument);
  EXPECT_THROW(ReferencePath(points, {0.5, -0.1, 30.0}), std::invalid_argument);
  EXPECT_THROW(ReferencePath(points, {0.5, 0.9, 0.5}), std::invalid_argument);
}

TEST(ReferencePath, BearsRepeatedPoints) {
  const ReferencePath path({{0.0, 0.0}, {0.0, 0.0}, {2.0, 0.0}, {2.0, 0.0}, {5.0, 0.0}}, kParams);
  EXPECT_NEAR(path.length(), 5.0, 1e-9);
  for (const double k : path.curvature()) EXPECT_NEAR(k, 0.0, 1e-9);
}

}  // namespace
}  // namespace hairpin
