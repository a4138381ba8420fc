#include "daemons/boundary_estimator/stretch.hpp"

namespace hairpin {
void Stretch::Append(const CrossedEdge& edge, const Gate& gate) {
  edges.push_back(edge);
  gates.push_back(gate);
}

Eigen::Vector2d Stretch::end() const {
  return empty() ? Eigen::Vector2d(0.0, 0.0) : gates.back().middle();
}

Eigen::Vector2d Stretch::end_direction() const {
  if (empty()) return Eigen::Vector2d::UnitX();
  const Eigen::Vector2d before =
      size() > 1 ? gates[size() - 2].middle() : Eigen::Vector2d(0.0, 0.0);
  return (end() - before).stableNormalized();
}

std::optional<double> Stretch::MeanWidth() const {
  if (size() < 2) return std::nullopt;
  double sum = 0.0;
  for (size_t i = 1; i < size(); ++i) sum += WidthBetween(gates[i - 1], gates[i]);
  return sum / static_cast<double>(size() - 1);
}

double WidthBetween(const Gate& before, const Gate& gate) {
  if (gate.left == before.left) return DistanceToSegment(gate.left, before.right, gate.right);
  return DistanceToSegment(gate.right, before.left, gate.left);
}

PathScore ScoreOf(const Scene& scene, const Stretch& stretch, const PathScoreParams& params) {
  PathFeatures features(Eigen::Vector2d::Zero(), Eigen::Vector2d::UnitX());
  double log_likelihood = 0.0;
  CrossedEdge last{CrossedEdge::kInferred, CrossedEdge::kInferred};
  const auto spacing = [&](int from, int to) {
    if (from == CrossedEdge::kInferred) return 0.0;
    return (scene.positions[static_cast<size_t>(from)] - scene.positions[static_cast<size_t>(to)])
        .norm();
  };
  for (size_t i = 0; i < stretch.size(); ++i) {
    const auto [left, right] = stretch.edges[i];
    if (left != CrossedEdge::kInferred && left != last.left) {
      if (spacing(last.left, left) >= params.min_spacing)
        features.AddLeftSpacing(spacing(last.left, left));
      log_likelihood += scene.ratios[static_cast<size_t>(left)].left;
      last.left = left;
    }
    if (right != CrossedEdge::kInferred && right != last.right) {
      if (spacing(last.right, right) >= params.min_spacing)
        features.AddRightSpacing(spacing(last.right, right));
      log_likelihood += scene.ratios[static_cast<size_t>(right)].right;
      last.right = right;
    }
    if (i > 0) features.AddWidth(WidthBetween(stretch.gates[i - 1], stretch.gates[i]));
    features.Cross(stretch.gates[i].middle(), params.min_segment);
  }
  return Score(features.values(), log_likelihood, params);
}

}  // namespace hairpin
