#pragma once

#include <Eigen/Core>
#include <bitset>
#include <optional>
#include <vector>

#include "daemons/boundary_estimator/delaunay.hpp"
#include "daemons/boundary_estimator/stretch.hpp"

namespace hairpin {

struct PathSearchParams {
  int beam_width = 0;        // paths kept at each depth of the tree
  int max_edges = 0;         // depth of the tree
  double horizon = 0.0;      // m; a path that is longer is not expanded
  double min_width = 0.0;    // m; of a crossed edge
  double max_width = 0.0;    // m
  double max_spacing = 0.0;  // m; between consecutive cones of a side
  double max_turn = 0.0;     // rad; largest angle change of a path, from the car's heading on
};

/// Throws std::invalid_argument naming the parameter, the relation and the bound.
void Check(const PathSearchParams& params);

struct ScoredPath {
  std::vector<CrossedEdge> edges;  // from the car outward
  PathScore score;
};

struct PathSearchResult {
  std::optional<ScoredPath> winner;
  std::optional<ScoredPath> runner_up;  // the best that neither begins nor continues the winner
  int num_candidates = 0;               // paths that were scored
};

/// Tree of middle paths through a triangulation [paper III-D]: from the car at the origin, heading
/// along x, through the midpoints of the edges crossed. A path enters no triangle twice and has no
/// cone twice, on whichever side. Every node is a candidate; before its first gate a path may cross
/// edges too wide for one, where cones near the car are missing: they count in nothing. At each
/// depth the `beam_width` best by log posterior are expanded. Ties go to the candidate found first.
class PathSearch {
 public:
  static constexpr size_t kMaxCones = 128;
  static constexpr size_t kMaxTriangles = 2 * kMaxCones;

  PathSearch(const PathSearchParams& params, const PathScoreParams& score_params);

  /// `triangulation` is that of the scene's positions. Throws std::invalid_argument for more than
  /// kMaxCones of them.
  PathSearchResult Search(const Scene& scene, const Triangulation& triangulation);

 private:
  struct Node {
    int parent;
    CrossedEdge edge;
    int next_triangle;
    PathFeatures features;
    double log_likelihood;
    double log_posterior;
    std::bitset<kMaxCones> cones;
    std::bitset<kMaxTriangles> triangles;
  };
  struct Problem {
    const std::vector<Eigen::Vector2d>& positions;
    const std::vector<SideLogRatios>& ratios;
    const std::vector<Triangulation::Triangle>& triangles;
  };

  void AddRoots(const Problem& problem);
  void AddRoot(const Problem& problem, const CrossedEdge& edge, int from_triangle,
               int next_triangle);
  void Expand(const Problem& problem, int parent);
  void AddChild(const Problem& problem, int parent, int vertex, bool on_left, int next_triangle);
  void CrossAndKeep(const Problem& problem, Node& node);
  std::optional<int> Best(const std::vector<bool>& excluded) const;
  std::vector<bool> RelativesOf(int node) const;
  ScoredPath PathTo(int node) const;

  PathSearchParams params_;
  PathScoreParams score_params_;
  double least_cosine_;
  std::vector<Node> nodes_;  // parents before children
  std::vector<int> level_;
};

}  // namespace hairpin
