#include "common/cone.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hairpin {
namespace {

cone_observation_t GoodMessage() {
  ConeObservation observation;
  observation.position = {5.0, -2.0};
  observation.covariance << 0.04, 0.01, 0.01, 0.09;
  observation.colour = {0.1, 0.6, 0.1, 0.1, 0.1};
  return ToMessage(observation);
}

TEST(ConeObservation, ComesBackFromTheWireAsItWas) {
  const auto observation = ToConeObservation(GoodMessage());
  ASSERT_TRUE(observation);
  EXPECT_EQ(observation->position, Eigen::Vector2d(5.0, -2.0));
  EXPECT_EQ(observation->covariance(0, 1), 0.01);
  EXPECT_EQ(observation->covariance(1, 0), 0.01);
  EXPECT_NEAR(ProbabilityOf(observation->colour, ConeColour::kBlue), 0.6, 1e-6);
}

TEST(ConeObservation, IsRefusedWithoutAPositiveDefiniteCovariance) {
  for (const double xy : {0.06, 1.0, -0.06}) {
    cone_observation_t message = GoodMessage();
    message.covariance_xy_m2 = xy;
    EXPECT_FALSE(ToConeObservation(message)) << xy;
  }
  cone_observation_t message = GoodMessage();
  message.covariance_xx_m2 = -0.04;
  EXPECT_FALSE(ToConeObservation(message));
}

TEST(ConeObservation, IsRefusedWhereTheProbabilitiesAreNoDistribution) {
  for (const float blue :
       {-0.1f, 0.0f, 0.58f, 0.62f, 2.0f, std::numeric_limits<float>::quiet_NaN()}) {
    cone_observation_t message = GoodMessage();
    message.probability[1] = blue;
    EXPECT_FALSE(ToConeObservation(message)) << blue;
  }
  cone_observation_t rounded = GoodMessage();
  rounded.probability[1] = 0.605f;
  const auto observation = ToConeObservation(rounded);
  ASSERT_TRUE(observation) << "rounding is none of it";
  double sum = 0.0;
  for (const double p : observation->colour) sum += p;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(ConeObservation, IsRefusedBeyondEverySensorsReach) {
  for (const double x : {200.0, -1e9, std::numeric_limits<double>::infinity(), std::nan("")}) {
    cone_observation_t message = GoodMessage();
    message.x_m = x;
    EXPECT_FALSE(ToConeObservation(message)) << x;
  }
}

TEST(ColourDistribution, IsScaledToOneOrRefused) {
  const auto normalised = Normalised({1.0, 2.0, 1.0, 0.0, 0.0});
  ASSERT_TRUE(normalised);
  EXPECT_EQ((*normalised)[1], 0.5);
  EXPECT_FALSE(Normalised({0.0, 0.0, 0.0, 0.0, 0.0}));
  EXPECT_FALSE(Normalised({1.0, -0.1, 0.0, 0.0, 0.0}));
  EXPECT_FALSE(Normalised({1.0, std::nan(""), 0.0, 0.0, 0.0}));
  EXPECT_FALSE(Normalised({1e308, 1e308, 1e308, 0.0, 0.0})) << "the sum is not finite";
}

TEST(ColourDistribution, GivesTheMostProbableAndTheFirstOnATie) {
  EXPECT_EQ(MostProbable({0.1, 0.2, 0.4, 0.2, 0.1}), ConeColour::kYellow);
  EXPECT_EQ(MostProbable({0.0, 0.5, 0.5, 0.0, 0.0}), ConeColour::kBlue);
  EXPECT_EQ(MostProbable(kColourUnknown), ConeColour::kUnknown);
}

TEST(ConeColour, KeepsItsNameAndItsNumberOnTheWire) {
  for (int i = 0; i < kNumConeColours; ++i) {
    const auto colour = static_cast<ConeColour>(i);
    EXPECT_EQ(ConeColourFromName(NameOf(colour)), colour);
  }
  EXPECT_FALSE(ConeColourFromName("green"));
  EXPECT_EQ(static_cast<int>(ConeColour::kYellow), cone_observation_t::YELLOW);
  EXPECT_EQ(static_cast<int>(ConeColour::kOrangeLarge), cone_observation_t::ORANGE_LARGE);
}

}  // namespace
}  // namespace hairpin
