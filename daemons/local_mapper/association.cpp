#include "daemons/local_mapper/association.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace hairpin {
namespace {

struct Pair {
  double distance;  // D_B
  size_t observation;
  size_t landmark;

  bool operator<(const Pair& other) const {
    return std::tie(distance, observation, landmark) <
           std::tie(other.distance, other.observation, other.landmark);
  }
};

std::vector<Pair> PairsInGate(const std::vector<Gaussian2>& landmarks,
                              const std::vector<Gaussian2>& observations,
                              const AssociationParams& params) {
  const Eigen::Matrix2d unmodelled =
      params.gate_sigma * params.gate_sigma * Eigen::Matrix2d::Identity();
  std::vector<Pair> pairs;
  for (size_t o = 0; o < observations.size(); ++o) {
    const Gaussian2& observation = observations[o];
    const Eigen::Matrix2d noise = observation.covariance + unmodelled;
    for (size_t l = 0; l < landmarks.size(); ++l) {
      const Gaussian2& landmark = landmarks[l];
      const Eigen::Vector2d d = observation.mean - landmark.mean;
      // No eigenvalue exceeds the trace, so this rules out most pairs without an inverse, and none
      // wrongly.
      const double trace = noise.trace() + landmark.covariance.trace();
      if (d.squaredNorm() > params.gate_chi2 * trace) continue;
      const Eigen::Matrix2d innovation_covariance = noise + landmark.covariance;
      if (d.dot(innovation_covariance.inverse() * d) > params.gate_chi2) continue;
      const Gaussian2 predicted{landmark.mean, landmark.covariance + observation.covariance};
      pairs.push_back({BhattacharyyaDistance(predicted, observation), o, l});
    }
  }
  return pairs;
}

}  // namespace

double BhattacharyyaDistance(const Gaussian2& a, const Gaussian2& b) {
  const Eigen::Matrix2d S = 0.5 * (a.covariance + b.covariance);
  const Eigen::Vector2d d = a.mean - b.mean;
  const double determinants = a.covariance.determinant() * b.covariance.determinant();
  return d.dot(S.inverse() * d) / 8.0 + 0.5 * std::log(S.determinant() / std::sqrt(determinants));
}

std::vector<std::optional<size_t>> Associate(const std::vector<Gaussian2>& landmarks,
                                             const std::vector<Gaussian2>& observations,
                                             const AssociationParams& params) {
  std::vector<Pair> pairs = PairsInGate(landmarks, observations, params);
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::optional<size_t>> landmark_of(observations.size());
  std::vector<bool> taken(landmarks.size(), false);
  for (const Pair& pair : pairs) {
    if (landmark_of[pair.observation] || taken[pair.landmark]) continue;
    landmark_of[pair.observation] = pair.landmark;
    taken[pair.landmark] = true;
  }
  return landmark_of;
}

}  // namespace hairpin
