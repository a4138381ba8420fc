#include "daemons/boundary_estimator/middle_path.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "tests/unit/boundary_estimator/shipped_params.hpp"

namespace hairpin {
namespace {

// Gates across a lane along x, `spacing` apart, the last at `end`.
Stretch StraightStretch(double end, double spacing, double width = 3.0) {
  Stretch stretch;
  int cone = 0;
  for (double x = spacing; x <= end; x += spacing, cone += 2) {
    stretch.Append({cone, cone + 1}, {{x, 0.5 * width}, {x, -0.5 * width}});
  }
  return stretch;
}

TEST(MiddlePath, OfNoGatesHasNoPoints) {
  EXPECT_TRUE(BuildMiddlePath({0.0, 0.0}, {}, test::ShippedParams().path).points.empty());
}

TEST(MiddlePath, IsEvenlySpacedFromTheCarThroughTheMiddles) {
  const MiddlePathParams params = test::ShippedParams().path;
  const MiddlePath path = BuildMiddlePath({0.0, 0.0}, StraightStretch(12.0, 3.0), params);
  EXPECT_TRUE(path.points.front().position.isZero());
  EXPECT_NEAR(path.seen_length, 12.0, 1e-9);
  EXPECT_NEAR(path.length, 12.0 + params.extrapolation, 1e-9);
  double length = 0.0;
  for (size_t i = 1; i < path.points.size(); ++i) {
    length += (path.points[i].position - path.points[i - 1].position).norm();
    EXPECT_NEAR(path.points[i].position.y(), 0.0, 1e-9);
    EXPECT_NEAR(path.points[i].width, 3.0, 1e-9);
    EXPECT_EQ(path.points[i].extrapolated, path.points[i].position.x() > 12.0 + 1e-9);
  }
  EXPECT_NEAR(length, path.length, 1e-9);
}

TEST(MiddlePath, EndsAtItsLargestLength) {
  const MiddlePathParams params = test::ShippedParams().path;
  const MiddlePath path = BuildMiddlePath({0.0, 0.0}, StraightStretch(60.0, 3.0), params);
  EXPECT_NEAR(path.length, params.max_length, params.point_spacing);
  EXPECT_EQ(path.length, path.seen_length);
}

TEST(MiddlePath, CountsAOneSidedEndIntoWhatItMayGuess) {
  const MiddlePathParams params = test::ShippedParams().path;
  Stretch stretch = StraightStretch(6.0, 3.0);
  stretch.Append({20, CrossedEdge::kInferred}, {{9.0, 1.5}, {9.0, -1.5}});
  const MiddlePath path = BuildMiddlePath({0.0, 0.0}, stretch, params);
  EXPECT_NEAR(path.seen_length, 9.0, 1e-9);
  EXPECT_NEAR(path.length, 6.0 + params.extrapolation, 1e-9);
}

TEST(MiddlePath, GoesOnWithItsBendWhichDecays) {
  MiddlePathParams params = test::ShippedParams().path;
  constexpr double kRadius = 10.0;
  Stretch stretch;
  for (int i = 1; i <= 10; ++i) {
    const double angle = 0.1 * i;
    const Eigen::Vector2d outward(std::sin(angle), -std::cos(angle)), centre(0.0, kRadius);
    stretch.Append({2 * i, 2 * i + 1},
                   {centre + (kRadius - 1.5) * outward, centre + (kRadius + 1.5) * outward});
  }
  const auto end_heading = [&] {
    const auto points = BuildMiddlePath({0.0, 0.0}, stretch, params).points;
    const Eigen::Vector2d last = points.back().position - points[points.size() - 2].position;
    return std::atan2(last.y(), last.x());
  };
  // The last chord of the gates heads half a step, 0.05 rad, back from the circle's end.
  params.curvature_decay = 1e6;
  EXPECT_NEAR(end_heading(), 0.95 + params.extrapolation / kRadius, 0.06);
  params.curvature_decay = 1e-6;
  EXPECT_NEAR(end_heading(), 0.95, 0.06);
  params.curvature_decay = 1e6;
  params.max_extrapolated_curvature = 0.0;
  EXPECT_NEAR(end_heading(), 0.95, 0.06);
}

TEST(MiddlePathParams, AreRefusedOutOfRange) {
  const auto refused = [](const std::function<void(MiddlePathParams&)>& spoil) {
    MiddlePathParams params = test::ShippedParams().path;
    spoil(params);
    EXPECT_THROW(Check(params), std::invalid_argument);
  };
  refused([](auto& p) { p.point_spacing = 0.0; });
  refused([](auto& p) { p.smoothing_passes = -1; });
  refused([](auto& p) { p.max_length = p.point_spacing; });
  refused([](auto& p) { p.extrapolation = -1.0; });
  refused([](auto& p) { p.curvature_window = 0.0; });
  refused([](auto& p) { p.curvature_decay = 0.0; });
  refused([](auto& p) { p.max_extrapolated_curvature = -0.1; });
}

}  // namespace
}  // namespace hairpin
