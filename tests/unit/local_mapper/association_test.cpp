#include "daemons/local_mapper/association.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/geometry.hpp"

namespace hairpin {
namespace {

using ::testing::ElementsAre;
using ::testing::Optional;

constexpr AssociationParams kParams{.gate_chi2 = 11.8, .gate_sigma = 0.08};

Gaussian2 Round(double x, double y, double sigma) {
  return {{x, y}, sigma * sigma * Eigen::Matrix2d::Identity()};
}

/// As a camera sees at 15 m straight ahead: poor in depth.
Gaussian2 Coarse(double x, double y) {
  return {{x, y}, Eigen::Vector2d(0.75 * 0.75, 0.1 * 0.1).asDiagonal()};
}

TEST(BhattacharyyaDistance, IsZeroForEqualDistributions) {
  EXPECT_NEAR(BhattacharyyaDistance(Round(1.0, 2.0, 0.3), Round(1.0, 2.0, 0.3)), 0.0, 1e-12);
}

TEST(BhattacharyyaDistance, IsAnEighthOfTheSquaredMahalanobisDistanceForEqualCovariances) {
  EXPECT_NEAR(BhattacharyyaDistance(Round(0.0, 0.0, 0.5), Round(1.0, 0.0, 0.5)), 1.0 / 8.0 / 0.25,
              1e-12);
}

TEST(BhattacharyyaDistance, GrowsWithTheRatioOfCovariancesByTheClosedForm) {
  // Sigmas 1 and 3 on both axes: 1/2 ln((5 * 5) / sqrt(1 * 81)).
  EXPECT_NEAR(BhattacharyyaDistance(Round(0.0, 0.0, 1.0), Round(0.0, 0.0, 3.0)),
              0.5 * std::log(25.0 / 9.0), 1e-12);
}

TEST(BhattacharyyaDistance, IsSymmetricAndTurnsWithTheWorld) {
  const Gaussian2 a = Coarse(10.0, 1.0);
  const Gaussian2 b = Round(10.4, 1.2, 0.2);
  const Pose2 turn{3.0, -2.0, 0.7};
  const auto turned = [&](const Gaussian2& g) {
    return Gaussian2{turn * g.mean, RotateCovariance(g.covariance, turn.yaw)};
  };
  EXPECT_NEAR(BhattacharyyaDistance(a, b), BhattacharyyaDistance(b, a), 1e-12);
  EXPECT_NEAR(BhattacharyyaDistance(turned(a), turned(b)), BhattacharyyaDistance(a, b), 1e-9);
}

TEST(Association, LetsAWellKnownConeTakeACoarseFarObservation) {
  EXPECT_THAT(Associate({Round(15.0, 0.0, 0.03)}, {Coarse(16.0, 0.1)}, kParams),
              ElementsAre(Optional(0u)));
}

TEST(Association, LetsAVagueConeTakeAPreciseObservation) {
  EXPECT_THAT(Associate({Coarse(16.0, 0.1)}, {Round(15.0, 0.0, 0.05)}, kParams),
              ElementsAre(Optional(0u)));
}

TEST(Association, PrefersTheWellKnownConeToAVaguePhantomAtTheSamePlace) {
  EXPECT_THAT(Associate({Coarse(15.0, 0.0), Round(15.0, 0.0, 0.03)}, {Coarse(15.2, 0.0)}, kParams),
              ElementsAre(Optional(1u)));
}

TEST(Association, KeepsNeighbours1point2MetresApart) {
  const std::vector<Gaussian2> landmarks{Round(8.0, 0.0, 0.03)};
  EXPECT_THAT(Associate(landmarks, {Round(9.2, 0.0, 0.08)}, kParams), ElementsAre(std::nullopt));
}

TEST(Association, GivesAConflictToTheSmallerDistanceAndTheLoserToItsNextBest) {
  const std::vector<Gaussian2> landmarks{Coarse(10.0, 0.0), Coarse(11.2, 0.0)};
  EXPECT_THAT(Associate(landmarks, {Coarse(10.4, 0.0), Coarse(10.1, 0.0)}, kParams),
              ElementsAre(Optional(1u), Optional(0u)));
}

TEST(Association, NeverGivesALandmarkTwoObservations) {
  EXPECT_THAT(
      Associate({Round(5.0, 0.0, 0.1)}, {Round(5.0, 0.1, 0.1), Round(5.0, 0.05, 0.1)}, kParams),
      ElementsAre(std::nullopt, Optional(0u)));
}

TEST(Association, EqualsTheNaiveGreedyAssignmentOnRandomInput) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0.0, 12.0);
  std::uniform_real_distribution<double> spread(0.02, 0.8);
  for (int round = 0; round < 50; ++round) {
    std::vector<Gaussian2> landmarks;
    std::vector<Gaussian2> observations;
    for (int i = 0; i < 30; ++i)
      landmarks.push_back(Round(place(random), place(random), spread(random)));
    for (int i = 0; i < 12; ++i)
      observations.push_back(Round(place(random), place(random), spread(random)));
    std::vector<std::optional<size_t>> naive(observations.size());
    std::vector<bool> taken(landmarks.size(), false);
    for (;;) {
      double best = INFINITY;
      size_t best_o = 0;
      size_t best_l = 0;
      for (size_t o = 0; o < observations.size(); ++o) {
        for (size_t l = 0; l < landmarks.size(); ++l) {
          if (naive[o] || taken[l]) continue;
          const Eigen::Vector2d d = observations[o].mean - landmarks[l].mean;
          const double variance = observations[o].covariance(0, 0) + landmarks[l].covariance(0, 0);
          if (d.squaredNorm() / (variance + 0.08 * 0.08) > kParams.gate_chi2) continue;
          const Gaussian2 predicted{landmarks[l].mean,
                                    landmarks[l].covariance + observations[o].covariance};
          const double distance = BhattacharyyaDistance(predicted, observations[o]);
          if (distance >= best) continue;
          best = distance;
          best_o = o;
          best_l = l;
        }
      }
      if (std::isinf(best)) break;
      naive[best_o] = best_l;
      taken[best_l] = true;
    }
    EXPECT_EQ(Associate(landmarks, observations, kParams), naive);
  }
}

}  // namespace
}  // namespace hairpin
