#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemons/boundary_estimator/path_score.hpp"

namespace hairpin {

/// The cones that one step works on, in base.
struct Scene {
  std::vector<int64_t> ids;
  std::vector<Eigen::Vector2d> positions;  // m
  std::vector<SideLogRatios> ratios;
};

/// A line across the track, by its cones: indices into a scene. Of a crossed edge of the
/// triangulation both are there; where only one side was seen the other is kInferred.
struct CrossedEdge {
  static constexpr int kInferred = -1;
  int left;
  int right;
  bool operator==(const CrossedEdge&) const = default;
};

/// The same by its ends.
struct Gate {
  Eigen::Vector2d left = Eigen::Vector2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  Eigen::Vector2d middle() const { return 0.5 * (left + right); }
  double width() const { return (left - right).norm(); }
};

/// A stretch of track from the car outward: `gates[i]` belongs to `edges[i]`.
struct Stretch {
  std::vector<CrossedEdge> edges;
  std::vector<Gate> gates;

  size_t size() const { return gates.size(); }
  bool empty() const { return gates.empty(); }
  void Append(const CrossedEdge& edge, const Gate& gate);
  /// Where the middles end, and in which direction (unit vector); those of the car for an empty
  /// stretch.
  Eigen::Vector2d end() const;
  Eigen::Vector2d end_direction() const;
  /// Mean of WidthBetween() over the stretch; empty for fewer than two gates.
  std::optional<double> MeanWidth() const;
};

/// Width of the track where one side or both went on from gate to gate: the distance of a cone from
/// the stretch of side opposite. Edges are longer than that: every second one stands askew.
double WidthBetween(const Gate& before, const Gate& gate);

/// Features and score of a whole stretch, anew.
PathScore ScoreOf(const Scene& scene, const Stretch& stretch, const PathScoreParams& params);

}  // namespace hairpin
