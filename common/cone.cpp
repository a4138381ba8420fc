#include "common/cone.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/geometry.hpp"

namespace hairpin {
namespace {

constexpr std::array<std::string_view, kNumConeColours> kNames{"unknown", "blue", "yellow",
                                                               "orange", "orange_large"};
constexpr double kMaxDistance = 200.0;

}  // namespace

double ProbabilityOf(const ColourDistribution& distribution, ConeColour colour) {
  return distribution[static_cast<size_t>(colour)];
}

ConeColour MostProbable(const ColourDistribution& distribution) {
  return static_cast<ConeColour>(std::max_element(distribution.begin(), distribution.end()) -
                                 distribution.begin());
}

std::optional<ColourDistribution> Normalised(const ColourDistribution& weights) {
  const auto bad = [](double weight) { return !std::isfinite(weight) || weight < 0.0; };
  if (std::any_of(weights.begin(), weights.end(), bad)) return std::nullopt;
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(sum > 0.0) || !std::isfinite(sum)) return std::nullopt;
  ColourDistribution normalised = weights;
  for (double& weight : normalised) weight /= sum;
  return normalised;
}

std::string_view NameOf(ConeColour colour) { return kNames[static_cast<size_t>(colour)]; }

std::optional<ConeColour> ConeColourFromName(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<ConeColour>(found - kNames.begin());
}

std::optional<ConeObservation> ToConeObservation(const cone_observation_t& message) {
  ConeObservation observation;
  observation.position = {message.x_m, message.y_m};
  observation.covariance << message.covariance_xx_m2, message.covariance_xy_m2,
      message.covariance_xy_m2, message.covariance_yy_m2;
  ColourDistribution weights{};
  std::copy(std::begin(message.probability), std::end(message.probability), weights.begin());
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const std::optional<ColourDistribution> colour = Normalised(weights);
  if (!(observation.position.norm() < kMaxDistance) || !IsCovariance(observation.covariance))
    return std::nullopt;
  if (!colour || std::abs(sum - 1.0) > 0.01) return std::nullopt;
  observation.colour = *colour;
  return observation;
}

cone_observation_t ToMessage(const ConeObservation& observation) {
  cone_observation_t message{};
  message.x_m = observation.position.x();
  message.y_m = observation.position.y();
  message.covariance_xx_m2 = observation.covariance(0, 0);
  message.covariance_xy_m2 = observation.covariance(0, 1);
  message.covariance_yy_m2 = observation.covariance(1, 1);
  for (size_t i = 0; i < observation.colour.size(); ++i)
    message.probability[i] = static_cast<float>(observation.colour[i]);
  return message;
}

}  // namespace hairpin
