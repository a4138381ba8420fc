#include "daemons/boundary_estimator/boundary_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hairpin {
namespace {

size_t Index(int i) { return static_cast<size_t>(i); }

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Direction in which the middles of the gates arrive at the last one, starting at the car.
Eigen::Vector2d EndDirection(const std::vector<Gate>& gates) {
  const Eigen::Vector2d end = gates.back().middle();
  const Eigen::Vector2d before = gates.size() > 1 ? gates[gates.size() - 2].middle() : Eigen::Vector2d(0.0, 0.0);
  return (end - before).stableNormalized();
}

// Of the track across its direction: the crossed edges stand askew.
double MeanWidth(const std::vector<Gate>& gates) {
  double sum = 0.0;
  Eigen::Vector2d before = Eigen::Vector2d::Zero();
  for (const Gate& gate : gates) {
    sum += std::abs(Cross((gate.middle() - before).stableNormalized(), gate.left - gate.right));
    before = gate.middle();
  }
  return sum / static_cast<double>(gates.size());
}

}  // namespace

BoundaryEstimator::BoundaryEstimator(const BoundaryEstimatorParams& params)
    : params_(params), search_(params.search, params.score), width_seen_(params.side.default_width) {
  Check(params_.side);
  Check(params_.path);
}

BoundaryEstimator::Scene BoundaryEstimator::Select(const Pose2& T_local_base, const std::vector<MapCone>& cones) const {
  const Pose2 T_base_local = T_local_base.Inverse();
  Scene scene;
  for (const MapCone& cone : cones) {
    MapCone in_base = cone;
    in_base.position = T_base_local * cone.position;
    if (cone.existence < params_.min_existence || in_base.position.norm() > params_.max_range) continue;
    scene.cones.push_back(in_base);
  }
  const auto nearer = [](const MapCone& a, const MapCone& b) {
    const double ra = a.position.squaredNorm(), rb = b.position.squaredNorm();
    return ra < rb || (ra == rb && a.id < b.id);
  };
  std::sort(scene.cones.begin(), scene.cones.end(), nearer);
  if (scene.cones.size() > Index(params_.max_cones)) scene.cones.resize(Index(params_.max_cones));
  for (const MapCone& cone : scene.cones) {
    const SideLogRatios ratios = ToSideLogRatios(cone.colour, params_.score.min_probability);
    scene.positions.push_back(cone.position);
    scene.left_ratios.push_back(ratios.left);
    scene.right_ratios.push_back(ratios.right);
  }
  return scene;
}

void BoundaryEstimator::ContinueOnOneSide(const Scene& scene, Stretch& stretch) const {
  const Eigen::Vector2d end_direction = EndDirection(stretch.gates);
  const auto follow = [&](Side side) {
    std::vector<bool> taken(scene.cones.size(), false);
    std::vector<int> cones;  // of the side so far
    for (const CrossedEdge& edge : stretch.edges) {
      const int cone = side == Side::kLeft ? edge.left : edge.right;
      taken[Index(edge.left)] = taken[Index(edge.right)] = true;
      if (cones.empty() || cones.back() != cone) cones.push_back(cone);
    }
    const Eigen::Vector2d last = scene.positions[Index(cones.back())];
    Eigen::Vector2d direction = end_direction;
    if (cones.size() > 1) {
      const Eigen::Vector2d step = last - scene.positions[Index(cones[cones.size() - 2])];
      if (step.norm() >= params_.side.min_spacing) direction = step.normalized();
    }
    const auto& ratios = side == Side::kLeft ? scene.left_ratios : scene.right_ratios;
    return FollowSide(scene.positions, ratios, cones.back(), direction, taken, params_.side);
  };
  const std::vector<int> left = follow(Side::kLeft);
  const std::vector<int> right = follow(Side::kRight);
  const Side side = left.size() >= right.size() ? Side::kLeft : Side::kRight;
  const std::vector<int>& chain = side == Side::kLeft ? left : right;
  if (chain.empty()) return;
  std::vector<Eigen::Vector2d> cones;
  for (const int cone : chain) cones.push_back(scene.positions[Index(cone)]);
  const CrossedEdge last = stretch.edges.back();
  const std::vector<Gate> gates =
      InferGates(scene.positions[Index(side == Side::kLeft ? last.left : last.right)], cones, side, MeanWidth(stretch.gates));
  for (size_t i = 0; i < gates.size(); ++i) {
    const Eigen::Vector2d step = gates[i].middle() - stretch.gates.back().middle();
    if (step.dot(EndDirection(stretch.gates)) < 0.5) continue;
    stretch.gates.push_back(gates[i]);
    stretch.edges.push_back(side == Side::kLeft ? CrossedEdge{chain[i], kInferred} : CrossedEdge{kInferred, chain[i]});
  }
}

TrackEstimate BoundaryEstimator::Estimate(const Pose2& T_local_base, const std::vector<MapCone>& cones) {
  const Scene scene = Select(T_local_base, cones);
  std::vector<SideLogRatios> ratios;
  for (size_t i = 0; i < scene.cones.size(); ++i) ratios.push_back({scene.left_ratios[i], scene.right_ratios[i]});
  const PathSearchResult found = search_.Search(scene.positions, ratios, Triangulate(scene.positions));
  TrackEstimate estimate;
  estimate.num_candidates = found.num_candidates;
  if (!found.winner) return estimate;
  Stretch stretch;
  for (const CrossedEdge& edge : found.winner->edges) {
    stretch.gates.push_back({scene.positions[Index(edge.left)], scene.positions[Index(edge.right)]});
    stretch.edges.push_back(edge);
  }
  ContinueOnOneSide(scene, stretch);
  const auto append = [&](std::vector<BoundaryPoint>& side, int index, const Eigen::Vector2d& position) {
    const int64_t id = index == kInferred ? 0 : scene.cones[Index(index)].id;
    if (id != 0 && !side.empty() && side.back().id == id) return;
    side.push_back({id, T_local_base * position});
  };
  for (size_t i = 0; i < stretch.edges.size(); ++i) {
    append(estimate.left, stretch.edges[i].left, stretch.gates[i].left);
    append(estimate.right, stretch.edges[i].right, stretch.gates[i].right);
  }
  estimate.valid = true;
  estimate.path = BuildMiddlePath(Eigen::Vector2d::Zero(), stretch.gates, found.winner->edges.size(), params_.path);
  for (PathPoint& point : estimate.path.points) point.position = T_local_base * point.position;
  estimate.winner = found.winner->score;
  if (found.runner_up) estimate.runner_up = found.runner_up->score;
  return estimate;
}

}  // namespace hairpin
