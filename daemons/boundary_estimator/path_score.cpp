#include "daemons/boundary_estimator/path_score.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/require.hpp"

namespace hairpin {

void Check(const PathScoreParams& params) {
  constexpr Require require("PathScoreParams");
  require(params.prior_weight > 0.0, "prior_weight must be > 0");
  for (size_t j = 0; j < kNumFeatures; ++j) {
    require(params.weight[j] >= 0.0, "weight[" + std::to_string(j) + "] must be >= 0");
    require(params.setpoint[j] >= 0.0, "setpoint[" + std::to_string(j) + "] must be >= 0");
    require(params.normaliser[j] > 0.0, "normaliser[" + std::to_string(j) + "] must be > 0");
  }
  require(params.min_probability > 0.0 && params.min_probability < 0.5,
          "min_probability must be in (0, 0.5)");
  require(params.min_spacing >= 0.0, "min_spacing must be >= 0");
  require(params.min_segment >= 0.0, "min_segment must be >= 0");
}

SideLogRatios ToSideLogRatios(const ColourDistribution& colour, double min_probability) {
  const auto clamped = [&](double p) {
    return std::clamp(p, min_probability, 1.0 - min_probability);
  };
  const double blue = clamped(ProbabilityOf(colour, ConeColour::kBlue));
  const double yellow = clamped(ProbabilityOf(colour, ConeColour::kYellow));
  const double either = clamped(ProbabilityOf(colour, ConeColour::kUnknown) +
                                ProbabilityOf(colour, ConeColour::kOrange) +
                                ProbabilityOf(colour, ConeColour::kOrangeLarge));
  const double log_most = std::log(std::max({blue, yellow, either}));
  return {std::log(std::max(blue, either)) - log_most,
          std::log(std::max(yellow, either)) - log_most};
}

void PathFeatures::Deviation::Add(double value) {
  ++count;
  const double difference = value - mean;
  mean += difference / count;
  squares += difference * (value - mean);
}

double PathFeatures::Deviation::value() const {
  return count == 0 ? 0.0 : std::sqrt(squares / count);
}

double DistanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                         const Eigen::Vector2d& to) {
  const Eigen::Vector2d step = to - from;
  const double squared = step.squaredNorm();
  const double ratio =
      squared > 0.0 ? std::clamp((point - from).dot(step) / squared, 0.0, 1.0) : 0.0;
  return (point - from - ratio * step).norm();
}

void PathFeatures::Cross(const Eigen::Vector2d& midpoint, double min_segment) {
  length_ += (midpoint - end_).norm();
  end_ = midpoint;
  ++edges_;
  const Eigen::Vector2d part = midpoint - anchor_;
  const double part_length = part.norm();
  if (part_length == 0.0 || part_length < min_segment) return;
  const Eigen::Vector2d direction = part / part_length;
  least_cosine_ = std::min(least_cosine_, direction.dot(direction_));
  direction_ = direction;
  anchor_ = midpoint;
}

FeatureValues PathFeatures::values() const {
  const double largest_turn = std::acos(std::max(least_cosine_, -1.0));
  return {largest_turn, left_.value(), right_.value(), width_.value(), static_cast<double>(edges_),
          length_};
}

PathScore Score(const FeatureValues& features, double log_likelihood,
                const PathScoreParams& params) {
  PathScore score;
  double cost = 0.0;
  for (size_t j = 0; j < kNumFeatures; ++j) {
    const bool limited = j >= 4;  // edges and length
    const double value = limited ? std::min(features[j], params.setpoint[j]) : features[j];
    const double difference = value - params.setpoint[j];
    score.term[j] = params.weight[j] * difference * difference / params.normaliser[j];
    cost += score.term[j];
  }
  score.log_prior = -params.prior_weight * cost;
  score.log_likelihood = log_likelihood;
  return score;
}

}  // namespace hairpin
