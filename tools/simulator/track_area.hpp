#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/simulator/track.hpp"

namespace hairpin {

/// The area between the boundaries of a track, in map [m]. A closed track is what lies between its
/// two loops; an open one goes on straight for 35 m before its first and past its last cones, where
/// cars wait and stop.
class TrackArea {
 public:
  /// Throws std::invalid_argument where a boundary is too short: three cones if closed, two if
  /// open.
  explicit TrackArea(const Track& track);

  /// True inside the track, by the lines through the cones' centres. Costs a few edges, whatever
  /// the track's length.
  bool Contains(const Eigen::Vector2d& point_map) const;

 private:
  struct Edge {
    Eigen::Vector2d from;
    Eigen::Vector2d to;
  };

  void AddPolygon(const std::vector<Eigen::Vector2d>& corners);
  void BuildSlabs();

  std::vector<Edge> edges_;
  double bottom_ = 0.0;                   // y of the first slab
  std::vector<std::vector<Edge>> slabs_;  // edges that reach into each metre of y
};

/// Where on the way from `before` to `after` a line is crossed forward, as the driver sees its left
/// and right end: +1 and the share of the way in (0, 1]; -1 backward; 0 not at all.
struct GateCrossing {
  int direction = 0;
  double share = 0.0;
};
GateCrossing CrossGate(const GateLine& line, const Eigen::Vector2d& before,
                       const Eigen::Vector2d& after);

}  // namespace hairpin
