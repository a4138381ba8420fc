#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string_view>

#include "hairpin/cone_observation_t.hpp"

namespace hairpin {

/// Colour classes, numbered as on the wire. Blue is left, yellow is right by the driver's view,
/// small orange marks entry and exit lanes, large orange the start/finish line.
enum class ConeColour { kUnknown = 0, kBlue = 1, kYellow = 2, kOrange = 3, kOrangeLarge = 4 };
inline constexpr int kNumConeColours = 5;

/// Probability of each class, indexed by ConeColour; sums to 1.
using ColourDistribution = std::array<double, kNumConeColours>;

inline constexpr ColourDistribution kColourUnknown{1.0, 0.0, 0.0, 0.0, 0.0};

double ProbabilityOf(const ColourDistribution& distribution, ConeColour colour);
/// The most probable class; the first one on a tie.
ConeColour MostProbable(const ColourDistribution& distribution);
/// Scaled to sum 1. Empty where an entry is negative or not finite, or where the sum is zero.
std::optional<ColourDistribution> Normalised(const ColourDistribution& weights);

/// "unknown", "blue", "yellow", "orange", "orange_large".
std::string_view NameOf(ConeColour colour);
/// Inverse of NameOf.
std::optional<ConeColour> ConeColourFromName(std::string_view name);

/// One cone as a pipeline sees it.
struct ConeObservation {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();        // base [m]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  // base [m^2]
  ColourDistribution colour = kColourUnknown;
};

/// Checked conversion from the wire. Empty where the covariance is not positive definite, the
/// probabilities are no distribution (within 1 %), or the position is beyond 200 m, which no sensor
/// here reaches.
std::optional<ConeObservation> ToConeObservation(const cone_observation_t& message);
cone_observation_t ToMessage(const ConeObservation& observation);

}  // namespace hairpin
