#include "daemons/boundary_estimator/boundary_estimator.hpp"

#include <algorithm>
#include <string>

#include "common/require.hpp"

namespace hairpin {
namespace {

// Gates of the search's path.
Stretch ToStretch(const Scene& scene, const std::vector<CrossedEdge>& edges) {
  Stretch stretch;
  for (const CrossedEdge& edge : edges) {
    stretch.Append(edge, {scene.positions[static_cast<size_t>(edge.left)],
                          scene.positions[static_cast<size_t>(edge.right)]});
  }
  return stretch;
}

std::vector<BoundaryPoint> SideOf(const Scene& scene, const Stretch& stretch, Side side,
                                  const Pose2& T_local_base) {
  std::vector<BoundaryPoint> points;
  for (size_t i = 0; i < stretch.size(); ++i) {
    const bool left = side == Side::kLeft;
    const int cone = left ? stretch.edges[i].left : stretch.edges[i].right;
    const int64_t id = cone == CrossedEdge::kInferred ? 0 : scene.ids[static_cast<size_t>(cone)];
    if (cone != CrossedEdge::kInferred && !points.empty() && points.back().id == id) continue;
    points.push_back({id, T_local_base * (left ? stretch.gates[i].left : stretch.gates[i].right)});
  }
  return points;
}

}  // namespace

BoundaryEstimator::BoundaryEstimator(const BoundaryEstimatorParams& params)
    : params_(params),
      search_(params.search, params.score),
      width_seen_(params.one_sided.default_width) {
  constexpr Require require("BoundaryEstimatorParams");
  require(params.min_existence >= 0.0 && params.min_existence <= 1.0,
          "min_existence must be in [0, 1]");
  require(params.near_min_existence >= params.min_existence && params.near_min_existence <= 1.0,
          "near_min_existence must be in [min_existence, 1]");
  require(params.near_range >= 0.0, "near_range must be >= 0");
  require(params.max_range > 0.0, "max_range must be > 0");
  require(params.max_cones >= 1 && static_cast<size_t>(params.max_cones) <= PathSearch::kMaxCones,
          "max_cones must be in [1, 128]");
  require(params.min_clear_share >= 0.0 && params.min_clear_share <= 1.0,
          "min_clear_share must be in [0, 1]");
  Check(params_.one_sided);
  Check(params_.path);
}

Scene BoundaryEstimator::Select(const Pose2& T_base_local,
                                const std::vector<MapCone>& cones) const {
  std::vector<MapCone> near;
  for (const MapCone& cone : cones) {
    MapCone in_base = cone;
    in_base.position = T_base_local * cone.position;
    const double range = in_base.position.norm();
    const double needed =
        range < params_.near_range ? params_.near_min_existence : params_.min_existence;
    if (cone.existence >= needed && range <= params_.max_range) near.push_back(in_base);
  }
  const auto nearer = [](const MapCone& a, const MapCone& b) {
    const double ra = a.position.squaredNorm(), rb = b.position.squaredNorm();
    return ra < rb || (ra == rb && a.id < b.id);
  };
  std::sort(near.begin(), near.end(), nearer);
  if (near.size() > static_cast<size_t>(params_.max_cones))
    near.resize(static_cast<size_t>(params_.max_cones));
  Scene scene;
  for (const MapCone& cone : near) {
    scene.ids.push_back(cone.id);
    scene.positions.push_back(cone.position);
    scene.ratios.push_back(ToSideLogRatios(cone.colour, params_.score.min_probability));
  }
  return scene;
}

// Best first.
std::vector<BoundaryEstimator::Hypothesis> BoundaryEstimator::OneSided(const Scene& scene) const {
  std::vector<Hypothesis> hypotheses;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const Stretch stretch = FollowSideFromCar(scene, side, width_seen_, params_.one_sided);
    if (!stretch.empty()) hypotheses.push_back({stretch, ScoreOf(scene, stretch, params_.score)});
  }
  const auto better = [](const Hypothesis& a, const Hypothesis& b) {
    return a.score.log_posterior() > b.score.log_posterior();
  };
  std::stable_sort(hypotheses.begin(), hypotheses.end(), better);
  return hypotheses;
}

BoundaryEstimator::Hypothesis BoundaryEstimator::Complete(
    const Scene& scene, const ScoredPath& path, const std::vector<Hypothesis>& one_sided) const {
  Hypothesis completed{ToStretch(scene, path.edges), path.score};
  for (const Hypothesis& side : one_sided)
    FillJump(side.stretch, params_.one_sided, completed.stretch);
  ContinueOnOneSide(scene, width_seen_, params_.one_sided, completed.stretch);
  return completed;
}

// Two sides that contradict no colour are never given up for one: the path would hop between the
// two from map to map.
bool BoundaryEstimator::Beats(const Scene& scene, const Hypothesis& one_sided,
                              const Hypothesis& searched) const {
  if (searched.score.log_likelihood >= params_.one_sided.min_log_ratio) return false;
  return one_sided.score.log_posterior() - params_.one_sided.log_penalty >
         ScoreOf(scene, searched.stretch, params_.score).log_posterior();
}

Fallback BoundaryEstimator::FallbackOf(const Scene& scene, const Stretch& stretch) const {
  const auto clear = [&](const SideLogRatios& ratios) {
    return std::min(ratios.left, ratios.right) < params_.one_sided.min_log_ratio;
  };
  const auto count = std::count_if(scene.ratios.begin(), scene.ratios.end(), clear);
  const double share = static_cast<double>(count) / static_cast<double>(scene.ratios.size());
  if (share < params_.min_clear_share) return Fallback::kColourBlind;
  const auto [left, right] = stretch.edges.front();
  const bool inferred = left == CrossedEdge::kInferred || right == CrossedEdge::kInferred;
  return inferred ? Fallback::kOneSided : Fallback::kNone;
}

// A path through slivers of triangles is no measure of a track.
void BoundaryEstimator::LearnWidth(const Stretch& stretch) {
  const double width = stretch.MeanWidth().value_or(0.0);
  if (width >= params_.search.min_width && width <= params_.search.max_width) width_seen_ = width;
}

TrackEstimate BoundaryEstimator::Estimate(const Pose2& T_local_base,
                                          const std::vector<MapCone>& cones) {
  const Scene scene = Select(T_local_base.Inverse(), cones);
  const PathSearchResult found = search_.Search(scene, Triangulate(scene.positions));
  if (found.winner) LearnWidth(ToStretch(scene, found.winner->edges));
  const std::vector<Hypothesis> one_sided = OneSided(scene);

  TrackEstimate estimate;
  estimate.num_candidates = found.num_candidates + static_cast<int>(one_sided.size());
  std::optional<Hypothesis> best;
  if (found.winner) best = Complete(scene, *found.winner, one_sided);
  if (found.runner_up) estimate.runner_up = found.runner_up->score;
  if (!one_sided.empty() && (!best || Beats(scene, one_sided.front(), *best))) {
    if (best) estimate.runner_up = best->score;
    best = one_sided.front();
  }
  if (!best) return estimate;
  estimate.valid = true;
  estimate.winner = best->score;
  estimate.fallback = FallbackOf(scene, best->stretch);
  estimate.left = SideOf(scene, best->stretch, Side::kLeft, T_local_base);
  estimate.right = SideOf(scene, best->stretch, Side::kRight, T_local_base);
  estimate.path = BuildMiddlePath(Eigen::Vector2d::Zero(), best->stretch, params_.path);
  for (PathPoint& point : estimate.path.points) point.position = T_local_base * point.position;
  return estimate;
}

}  // namespace hairpin
