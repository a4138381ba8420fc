#include "daemons/boundary_estimator/path_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr int kNoParent = -1;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Positive where the origin lies to the left of the line from a to b.
double OriginSide(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return Cross(b - a, -a); }

size_t Index(int i) { return static_cast<size_t>(i); }

double GateLogRatio(const std::vector<SideLogRatios>& ratios, const CrossedEdge& edge) {
  return ratios[Index(edge.left)].left + ratios[Index(edge.right)].right;
}

int Third(const std::array<int, 3>& vertex, const CrossedEdge& edge) {
  const auto other = [&](int v) { return v != edge.left && v != edge.right; };
  return *std::find_if(vertex.begin(), vertex.end(), other);
}

}  // namespace

void Check(const PathSearchParams& params) {
  constexpr Require require("PathSearchParams");
  require(params.beam_width >= 1, "beam_width must be >= 1");
  require(params.max_edges >= 1, "max_edges must be >= 1");
  require(params.horizon > 0.0, "horizon must be > 0");
  require(params.min_width > 0.0, "min_width must be > 0");
  require(params.max_width > params.min_width, "max_width must be > min_width");
  require(params.max_spacing > 0.0, "max_spacing must be > 0");
  require(params.max_turn > 0.0 && params.max_turn <= std::numbers::pi,
          "max_turn must be in (0, pi]");
}

PathSearch::PathSearch(const PathSearchParams& params, const PathScoreParams& score_params)
    : params_(params), score_params_(score_params), least_cosine_(std::cos(params.max_turn)) {
  Check(params_);
  Check(score_params_);
}

PathSearchResult PathSearch::Search(const Scene& scene, const Triangulation& triangulation) {
  if (scene.positions.size() > kMaxCones)
    throw std::invalid_argument("PathSearch: more than 128 positions");
  const Problem problem{scene.positions, scene.ratios, triangulation.triangles};
  nodes_.clear();
  level_.clear();
  AddRoots(problem);
  size_t level_begin = 0;
  for (int depth = 1; depth < params_.max_edges && level_begin < nodes_.size(); ++depth) {
    level_.resize(nodes_.size() - level_begin);
    std::iota(level_.begin(), level_.end(), static_cast<int>(level_begin));
    level_begin = nodes_.size();
    const size_t kept = std::min(level_.size(), Index(params_.beam_width));
    const auto better = [this](int a, int b) {
      const double difference = nodes_[Index(a)].log_posterior - nodes_[Index(b)].log_posterior;
      return difference > 0.0 || (difference == 0.0 && a < b);
    };
    std::partial_sort(level_.begin(), level_.begin() + static_cast<std::ptrdiff_t>(kept),
                      level_.end(), better);
    for (size_t i = 0; i < kept; ++i) Expand(problem, level_[i]);
  }
  PathSearchResult result;
  const auto has_gate = [](const Node& node) { return node.features.edges() > 0; };
  result.num_candidates = static_cast<int>(std::count_if(nodes_.begin(), nodes_.end(), has_gate));
  if (const auto winner = Best(std::vector<bool>(nodes_.size(), false))) {
    result.winner = PathTo(*winner);
    if (const auto second = Best(RelativesOf(*winner))) result.runner_up = PathTo(*second);
  }
  return result;
}

void PathSearch::AddRoots(const Problem& problem) {
  // Inside the hull a path leaves the triangle that holds the car; outside it enters through the
  // hull edges in sight.
  for (size_t t = 0; t < problem.triangles.size(); ++t) {
    const auto& [vertex, neighbour] = problem.triangles[t];
    std::array<bool, 3> inside{};
    for (size_t i = 0; i < 3; ++i) {
      const int from = vertex[(i + 1) % 3], to = vertex[(i + 2) % 3];
      inside[i] = OriginSide(problem.positions[Index(from)], problem.positions[Index(to)]) >= 0.0;
    }
    const bool holds_car = inside[0] && inside[1] && inside[2];
    for (size_t i = 0; i < 3; ++i) {
      const int from = vertex[(i + 1) % 3], to = vertex[(i + 2) % 3];
      const int triangle = static_cast<int>(t);
      if (holds_car) AddRoot(problem, {to, from}, triangle, neighbour[i]);
      if (!inside[i] && neighbour[i] == Triangulation::kOutside) {
        AddRoot(problem, {from, to}, Triangulation::kOutside, triangle);
      }
    }
  }
}

void PathSearch::AddRoot(const Problem& problem, const CrossedEdge& edge, int from_triangle,
                         int next_triangle) {
  Node node{};
  node.parent = kNoParent;
  node.edge = edge;
  node.next_triangle = next_triangle;
  node.features = PathFeatures(Eigen::Vector2d::Zero(), Eigen::Vector2d::UnitX());
  node.log_likelihood = GateLogRatio(problem.ratios, edge);
  node.cones.set(Index(edge.left));
  node.cones.set(Index(edge.right));
  if (from_triangle != Triangulation::kOutside) node.triangles.set(Index(from_triangle));
  CrossAndKeep(problem, node);
}

void PathSearch::Expand(const Problem& problem, int parent) {
  const Node& node = nodes_[Index(parent)];
  const CrossedEdge edge = node.edge;
  const int entered = node.next_triangle;
  if (entered == Triangulation::kOutside || node.triangles.test(Index(entered))) return;
  if (node.features.length() > params_.horizon) return;
  const auto& [vertex, neighbour] = problem.triangles[Index(entered)];
  for (size_t i = 0; i < 3; ++i) {
    // Leaving across the edge opposite the old left cone makes the third cone the new left one.
    if (vertex[i] == edge.left) AddChild(problem, parent, Third(vertex, edge), true, neighbour[i]);
    if (vertex[i] == edge.right)
      AddChild(problem, parent, Third(vertex, edge), false, neighbour[i]);
  }
}

void PathSearch::AddChild(const Problem& problem, int parent, int vertex, bool on_left,
                          int next_triangle) {
  Node node = nodes_[Index(parent)];
  if (node.cones.test(Index(vertex))) return;
  int& side = on_left ? node.edge.left : node.edge.right;
  const double spacing = (problem.positions[Index(vertex)] - problem.positions[Index(side)]).norm();
  const bool between_gates = node.features.edges() > 0;
  if (between_gates && spacing > params_.max_spacing) return;
  const bool counts = between_gates && spacing >= score_params_.min_spacing;
  if (between_gates) {
    const int opposite = on_left ? node.edge.right : node.edge.left;
    node.features.AddWidth(DistanceToSegment(problem.positions[Index(opposite)],
                                             problem.positions[Index(side)],
                                             problem.positions[Index(vertex)]));
  }
  side = vertex;
  node.cones.set(Index(vertex));
  node.triangles.set(Index(node.next_triangle));
  node.parent = parent;
  node.next_triangle = next_triangle;
  if (counts && on_left) node.features.AddLeftSpacing(spacing);
  if (counts && !on_left) node.features.AddRightSpacing(spacing);
  if (between_gates) {
    const SideLogRatios& ratios = problem.ratios[Index(vertex)];
    node.log_likelihood += on_left ? ratios.left : ratios.right;
  } else {
    node.log_likelihood =
        GateLogRatio(problem.ratios, node.edge);  // what was passed bounds no path yet
  }
  CrossAndKeep(problem, node);
}

void PathSearch::CrossAndKeep(const Problem& problem, Node& node) {
  const Eigen::Vector2d& left = problem.positions[Index(node.edge.left)];
  const Eigen::Vector2d& right = problem.positions[Index(node.edge.right)];
  const double width = (left - right).norm();
  const bool before_first_gate = node.features.edges() == 0;
  if (width < params_.min_width || (width > params_.max_width && !before_first_gate)) return;
  if (width <= params_.max_width)
    node.features.Cross(0.5 * (left + right), score_params_.min_segment);
  if (node.features.least_cosine() < least_cosine_) return;
  node.log_posterior =
      Score(node.features.values(), node.log_likelihood, score_params_).log_posterior();
  nodes_.push_back(node);
}

std::optional<int> PathSearch::Best(const std::vector<bool>& excluded) const {
  std::optional<int> best;
  for (size_t i = 0; i < nodes_.size(); ++i) {
    if (excluded[i] || nodes_[i].features.edges() == 0) continue;
    if (best && nodes_[i].log_posterior <= nodes_[Index(*best)].log_posterior) continue;
    best = static_cast<int>(i);
  }
  return best;
}

std::vector<bool> PathSearch::RelativesOf(int node) const {
  std::vector<bool> relatives(nodes_.size(), false);
  relatives[Index(node)] = true;
  for (size_t i = Index(node) + 1; i < nodes_.size(); ++i) {
    const int parent = nodes_[i].parent;
    relatives[i] = parent != kNoParent && relatives[Index(parent)];
  }
  for (int i = nodes_[Index(node)].parent; i != kNoParent; i = nodes_[Index(i)].parent)
    relatives[Index(i)] = true;
  return relatives;
}

ScoredPath PathSearch::PathTo(int node) const {
  ScoredPath path;
  path.score = Score(nodes_[Index(node)].features.values(), nodes_[Index(node)].log_likelihood,
                     score_params_);
  for (int i = node; i != kNoParent && nodes_[Index(i)].features.edges() > 0;
       i = nodes_[Index(i)].parent) {
    path.edges.push_back(nodes_[Index(i)].edge);
  }
  std::reverse(path.edges.begin(), path.edges.end());
  return path;
}

}  // namespace hairpin
