#include "daemons/boundary_estimator/path_score.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/unit/boundary_estimator/shipped_params.hpp"

namespace hairpin {
namespace {

using test::Certain;

TEST(SideLogRatios, FollowTheColourOfTheSide) {
  const SideLogRatios blue = ToSideLogRatios(Certain(ConeColour::kBlue), 0.01);
  EXPECT_EQ(blue.left, 0.0);
  EXPECT_DOUBLE_EQ(blue.right, std::log(0.01) - std::log(0.99));
  const SideLogRatios yellow = ToSideLogRatios(Certain(ConeColour::kYellow), 0.01);
  EXPECT_EQ(yellow.right, 0.0);
  EXPECT_DOUBLE_EQ(yellow.left, std::log(0.01) - std::log(0.99));
}

TEST(SideLogRatios, AreNothingForOrangeAndUnknownOnEitherSide) {
  for (const ConeColour colour :
       {ConeColour::kUnknown, ConeColour::kOrange, ConeColour::kOrangeLarge}) {
    const SideLogRatios ratios = ToSideLogRatios(Certain(colour), 0.01);
    EXPECT_EQ(ratios.left, 0.0);
    EXPECT_EQ(ratios.right, 0.0);
  }
}

TEST(SideLogRatios, TakeTheMoreProbableOfColourAndUnknown) {
  const SideLogRatios ratios = ToSideLogRatios({0.3, 0.5, 0.2, 0.0, 0.0}, 0.01);
  EXPECT_EQ(ratios.left, 0.0);
  EXPECT_DOUBLE_EQ(ratios.right, std::log(0.3) - std::log(0.5));
}

TEST(PathFeatures, OfAHandMadePathAreItsClosedForm) {
  PathFeatures features({0.0, 0.0}, {1.0, 0.0});
  features.Cross({2.0, 0.0}, 1.0);
  features.Cross({2.0, 3.0}, 1.0);
  features.AddLeftSpacing(3.0);
  features.AddLeftSpacing(5.0);
  features.AddRightSpacing(4.0);
  features.AddWidth(3.0);
  features.AddWidth(3.0);
  features.AddWidth(6.0);
  EXPECT_THAT(features.values(),
              testing::ElementsAre(testing::DoubleNear(std::numbers::pi / 2.0, 1e-12), 1.0, 0.0,
                                   testing::DoubleNear(std::sqrt(2.0), 1e-12), 2.0, 5.0));
}

TEST(PathFeatures, DoNotTurnOnPartsShorterThanASegment) {
  PathFeatures features({0.0, 0.0}, {1.0, 0.0});
  features.Cross({0.0, 0.5}, 1.0);
  EXPECT_EQ(features.values()[0], 0.0);
  EXPECT_EQ(features.length(), 0.5);
}

TEST(PathScore, IsWeightedPriorPlusLikelihood) {
  PathScoreParams params = test::ShippedParams().score;
  params.prior_weight = 10.0;
  params.weight = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  params.setpoint = {0.0, 0.0, 0.0, 0.0, 10.0, 20.0};
  params.normaliser = {1.0, 2.0, 4.0, 0.5, 100.0, 400.0};
  const PathScore score = Score({1.0, 2.0, 2.0, 1.0, 5.0, 30.0}, -3.0, params);
  EXPECT_THAT(score.term, testing::ElementsAre(testing::DoubleEq(0.1), testing::DoubleEq(0.4),
                                               testing::DoubleEq(0.3), testing::DoubleEq(0.8),
                                               testing::DoubleEq(0.125), 0.0));
  EXPECT_DOUBLE_EQ(score.log_prior, -17.25);
  EXPECT_DOUBLE_EQ(score.log_posterior(), -20.25);
}

TEST(PathScoreParams, AreRefusedOutOfRange) {
  const auto refused = [](const std::function<void(PathScoreParams&)>& spoil) {
    PathScoreParams params = test::ShippedParams().score;
    spoil(params);
    EXPECT_THROW(Check(params), std::invalid_argument);
  };
  EXPECT_NO_THROW(Check(test::ShippedParams().score));
  refused([](auto& p) { p.prior_weight = 0.0; });
  refused([](auto& p) { p.weight[2] = -1.0; });
  refused([](auto& p) { p.setpoint[5] = -1.0; });
  refused([](auto& p) { p.normaliser[3] = 0.0; });
  refused([](auto& p) { p.min_probability = 0.5; });
  refused([](auto& p) { p.min_probability = 0.0; });
  refused([](auto& p) { p.min_spacing = -1.0; });
  refused([](auto& p) { p.min_segment = -1.0; });
  refused([](auto& p) { p.weight[0] = std::nan(""); });
}

}  // namespace
}  // namespace hairpin
