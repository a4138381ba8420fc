#include "daemons/boundary_estimator/boundary_estimator.hpp"

#include <algorithm>
#include <stdexcept>

namespace hairpin {
namespace {

// Gates of the search's path.
Stretch ToStretch(const Scene& scene, const std::vector<CrossedEdge>& edges) {
  Stretch stretch;
  for (const CrossedEdge& edge : edges) {
    stretch.Append(edge, {scene.positions[static_cast<size_t>(edge.left)], scene.positions[static_cast<size_t>(edge.right)]});
  }
  return stretch;
}

void AppendPoint(const Scene& scene, int cone, const Eigen::Vector2d& position, std::vector<BoundaryPoint>& side) {
  const int64_t id = cone == CrossedEdge::kInferred ? 0 : scene.ids[static_cast<size_t>(cone)];
  if (id == 0 || side.empty() || side.back().id != id) side.push_back({id, position});
}

}  // namespace

BoundaryEstimator::BoundaryEstimator(const BoundaryEstimatorParams& params)
    : params_(params), search_(params.search, params.score), width_seen_(params.one_sided.default_width) {
  Check(params_.one_sided);
  Check(params_.path);
}

Scene BoundaryEstimator::Select(const Pose2& T_base_local, const std::vector<MapCone>& cones) const {
  std::vector<MapCone> near;
  for (const MapCone& cone : cones) {
    MapCone in_base = cone;
    in_base.position = T_base_local * cone.position;
    if (cone.existence < params_.min_existence || in_base.position.norm() > params_.max_range) continue;
    near.push_back(in_base);
  }
  const auto nearer = [](const MapCone& a, const MapCone& b) {
    const double ra = a.position.squaredNorm(), rb = b.position.squaredNorm();
    return ra < rb || (ra == rb && a.id < b.id);
  };
  std::sort(near.begin(), near.end(), nearer);
  if (near.size() > static_cast<size_t>(params_.max_cones)) near.resize(static_cast<size_t>(params_.max_cones));
  Scene scene;
  for (const MapCone& cone : near) {
    scene.ids.push_back(cone.id);
    scene.positions.push_back(cone.position);
    scene.ratios.push_back(ToSideLogRatios(cone.colour, params_.score.min_probability));
  }
  return scene;
}

std::optional<BoundaryEstimator::Hypothesis> BoundaryEstimator::BestOneSided(const Scene& scene) const {
  std::optional<Hypothesis> best;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    Hypothesis hypothesis{FollowSideFromCar(scene, side, width_seen_, params_.one_sided), {}};
    if (hypothesis.stretch.empty()) continue;
    hypothesis.score = ScoreOf(scene, hypothesis.stretch, params_.score);
    if (!best || hypothesis.score.log_posterior() > best->score.log_posterior()) best = hypothesis;
  }
  return best;
}

TrackEstimate BoundaryEstimator::Estimate(const Pose2& T_local_base, const std::vector<MapCone>& cones) {
  const Scene scene = Select(T_local_base.Inverse(), cones);
  const PathSearchResult found = search_.Search(scene, Triangulate(scene.positions));
  TrackEstimate estimate;
  estimate.num_candidates = found.num_candidates;
  std::optional<Hypothesis> best;
  if (found.winner) {
    best = {ToStretch(scene, found.winner->edges), found.winner->score};
    width_seen_ = best->stretch.MeanWidth();
    for (const Side side : {Side::kLeft, Side::kRight}) {
      FillJump(FollowSideFromCar(scene, side, width_seen_, params_.one_sided), params_.one_sided, best->stretch);
    }
    ContinueOnOneSide(scene, params_.one_sided, best->stretch);
  }
  const std::optional<Hypothesis> one_sided = BestOneSided(scene);
  if (one_sided && (!best || one_sided->score.log_posterior() - params_.one_sided.log_penalty >
                                 ScoreOf(scene, best->stretch, params_.score).log_posterior())) {
    best = one_sided;
  }
  if (!best) return estimate;
  const Stretch& stretch = best->stretch;
  for (size_t i = 0; i < stretch.size(); ++i) {
    AppendPoint(scene, stretch.edges[i].left, T_local_base * stretch.gates[i].left, estimate.left);
    AppendPoint(scene, stretch.edges[i].right, T_local_base * stretch.gates[i].right, estimate.right);
  }
  estimate.valid = true;
  estimate.path = BuildMiddlePath(Eigen::Vector2d::Zero(), stretch, params_.path);
  for (PathPoint& point : estimate.path.points) point.position = T_local_base * point.position;
  estimate.winner = best->score;
  if (found.runner_up) estimate.runner_up = found.runner_up->score;
  return estimate;
}

}  // namespace hairpin
