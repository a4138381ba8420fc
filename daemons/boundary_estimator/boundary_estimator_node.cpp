#include "daemons/boundary_estimator/boundary_estimator_node.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace hairpin {
namespace {

constexpr double kMaxCoordinate = 1e5;  // m; no lap drifts that far

// Empty where the cone cannot be used.
std::optional<MapCone> ToMapCone(const local_cone_t& message) {
  cone_observation_t observation{};
  observation.covariance_xx_m2 = message.covariance_xx_m2;
  observation.covariance_xy_m2 = message.covariance_xy_m2;
  observation.covariance_yy_m2 = message.covariance_yy_m2;
  std::copy(std::begin(message.probability), std::end(message.probability),
            std::begin(observation.probability));
  const std::optional<ConeObservation> checked = ToConeObservation(observation);
  const bool near =
      std::abs(message.x_m) <= kMaxCoordinate && std::abs(message.y_m) <= kMaxCoordinate;
  if (!checked || !near || !(message.existence >= 0.0F && message.existence <= 1.0F))
    return std::nullopt;
  return MapCone{message.id, {message.x_m, message.y_m}, checked->colour, message.existence};
}

path_score_t ToMessage(const PathScore& score) {
  path_score_t message{};
  std::copy(score.term.begin(), score.term.end(), std::begin(message.term));
  message.log_prior = score.log_prior;
  message.log_likelihood = score.log_likelihood;
  message.log_posterior = score.log_posterior();
  return message;
}

std::vector<boundary_point_t> ToMessage(const std::vector<BoundaryPoint>& side) {
  std::vector<boundary_point_t> message;
  for (const BoundaryPoint& point : side) {
    boundary_point_t& out = message.emplace_back();
    out.id = point.id;
    out.x_m = point.position.x();
    out.y_m = point.position.y();
  }
  return message;
}

void Fill(track_t& message, const MiddlePath& path) {
  message.length_m = path.length;
  message.seen_length_m = path.seen_length;
  for (const PathPoint& point : path.points) {
    path_point_t& out = message.path.emplace_back();
    out.x_m = point.position.x();
    out.y_m = point.position.y();
    out.width_m = point.width;
    out.extrapolated = point.extrapolated;
  }
  message.num_points = static_cast<int32_t>(message.path.size());
}

track_t ToMessage(const TrackEstimate& estimate, const local_map_t& map) {
  track_t message{};
  message.utime = map.utime;
  message.epoch = map.epoch;
  message.x_m = map.x_m;
  message.y_m = map.y_m;
  message.yaw_rad = map.yaw_rad;
  message.valid = estimate.valid;
  message.fallback = static_cast<int32_t>(estimate.fallback);
  Fill(message, estimate.path);
  message.left = ToMessage(estimate.left);
  message.num_left = static_cast<int32_t>(message.left.size());
  message.right = ToMessage(estimate.right);
  message.num_right = static_cast<int32_t>(message.right.size());
  message.num_candidates = estimate.num_candidates;
  message.winner = ToMessage(estimate.winner);
  message.has_runner_up = estimate.runner_up.has_value();
  message.runner_up = ToMessage(estimate.runner_up.value_or(PathScore{}));
  return message;
}

double Squared(double value) { return value * value; }

PathScoreParams LoadScoreParams(const Config& config) {
  const Config prior = config.Section("prior");
  PathScoreParams params;
  params.prior_weight = prior.Number("weight", {0.001, 1e4});
  const std::vector<double> weights = prior.Numbers("feature_weights", kNumFeatures, {0.0, 1e3});
  std::copy(weights.begin(), weights.end(), params.weight.begin());
  const double spacing = prior.Number("spacing_normaliser_m", {0.01, 100.0});
  const double edges = prior.Integer("desired_edges", 1, 100);
  const double length = prior.Number("desired_length_m", {1.0, 100.0});
  params.normaliser = {Squared(prior.Number("angle_normaliser_rad", {0.01, 10.0})),
                       Squared(spacing),
                       Squared(spacing),
                       Squared(prior.Number("width_normaliser_m", {0.01, 100.0})),
                       Squared(edges),
                       Squared(length)};
  params.setpoint = {0.0, 0.0, 0.0, 0.0, edges, length};
  params.min_spacing = prior.Number("min_spacing_m", {0.0, 3.0});
  params.min_segment = prior.Number("min_segment_m", {0.0, 10.0});
  params.min_probability = config.Section("likelihood").Number("min_probability", {1e-6, 0.2});
  return params;
}

PathSearchParams LoadSearchParams(const Config& config) {
  PathSearchParams params;
  params.beam_width = config.Integer("beam_width", 1, 1000);
  params.max_edges = config.Integer("max_edges", 1, 200);
  params.horizon = config.Number("horizon_m", {1.0, 100.0});
  params.min_width = config.Number("min_width_m", {0.1, 10.0});
  params.max_width = config.Number("max_width_m", {1.0, 50.0});
  params.max_spacing = config.Number("max_spacing_m", {1.0, 50.0});
  params.max_turn = config.Number("max_turn_rad", {0.1, 3.1416});
  return params;
}

OneSidedParams LoadOneSidedParams(const Config& config, double min_spacing) {
  OneSidedParams params;
  params.min_spacing = min_spacing;
  params.max_spacing = config.Number("max_spacing_m", {1.0, 50.0});
  params.max_turn = config.Number("max_turn_rad", {0.1, 1.5});
  params.min_log_ratio = config.Number("min_log_ratio", {-100.0, 0.0});
  params.max_jump = config.Number("max_jump_m", {1.0, 50.0});
  params.log_penalty = config.Number("log_penalty", {0.0, 1000.0});
  params.default_width = config.Number("default_width_m", {1.0, 20.0});
  return params;
}

MiddlePathParams LoadPathParams(const Config& config) {
  MiddlePathParams params;
  params.point_spacing = config.Number("point_spacing_m", {0.1, 5.0});
  params.join_length = config.Number("join_length_m", {0.0, 10.0});
  params.max_join_angle = config.Number("max_join_angle_rad", {0.0, 1.6});
  params.smoothing_passes = config.Integer("smoothing_passes", 0, 100);
  params.max_length = config.Number("max_length_m", {5.0, 100.0});
  params.extrapolation = config.Number("extrapolation_m", {0.0, 50.0});
  params.curvature_window = config.Number("curvature_window_m", {0.5, 50.0});
  params.curvature_decay = config.Number("curvature_decay_m", {0.1, 1000.0});
  params.max_extrapolated_curvature = config.Number("max_extrapolated_curvature_radpm", {0.0, 1.0});
  return params;
}

}  // namespace

BoundaryEstimatorParams LoadBoundaryEstimatorParams(const Config& config) {
  BoundaryEstimatorParams params;
  params.min_existence = config.Number("min_existence", {0.0, 1.0});
  params.near_min_existence = config.Number("near_min_existence", {0.0, 1.0});
  params.near_range = config.Number("near_range_m", {0.0, 100.0});
  params.max_range = config.Number("max_range_m", {5.0, 100.0});
  params.max_cones = config.Integer("max_cones", 3, static_cast<int>(PathSearch::kMaxCones));
  params.min_clear_share = config.Number("min_clear_share", {0.0, 1.0});
  params.score = LoadScoreParams(config);
  params.search = LoadSearchParams(config.Section("search"));
  params.one_sided = LoadOneSidedParams(config.Section("one_sided"), params.score.min_spacing);
  params.path = LoadPathParams(config.Section("path"));
  config.Finish();
  return params;
}

BoundaryEstimatorNode::BoundaryEstimatorNode(const BoundaryEstimatorParams& params, Bus& bus)
    : bus_(bus), estimator_(params) {
  bus.Subscribe(channels::kLocalMap, [this](const local_map_t& message) { OnLocalMap(message); });
}

void BoundaryEstimatorNode::OnLocalMap(const local_map_t& message) {
  const auto refuse = [this](const std::string& why) { bus_.Refuse(channels::kLocalMap, why); };
  if (message.utime <= last_utime_) return refuse("time goes back");
  if (std::abs(message.x_m) > kMaxCoordinate || std::abs(message.y_m) > kMaxCoordinate)
    return refuse("pose out of range");
  std::vector<MapCone> cones;
  std::set<int64_t> ids;
  for (const local_cone_t& cone : message.cones) {
    const std::optional<MapCone> checked = ToMapCone(cone);
    if (!checked)
      return refuse("cone " + std::to_string(cone.id) +
                    " has no proper covariance, colour, existence or place");
    if (!ids.insert(cone.id).second)
      return refuse("cone " + std::to_string(cone.id) + " stands twice");
    cones.push_back(*checked);
  }
  last_utime_ = message.utime;
  const Pose2 T_local_base{message.x_m, message.y_m, WrapAngle(message.yaw_rad)};
  bus_.Publish(channels::kTrack, ToMessage(estimator_.Estimate(T_local_base, cones), message));
}

}  // namespace hairpin
