#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "daemons/global_mapper/map_estimate.hpp"

namespace hairpin {

/// The start/finish line of a map, by the driver's view; it ends at the gate's cones.
struct MapGate {
  Eigen::Vector2d left = Eigen::Vector2d::Zero();  // map [m]
  Eigen::Vector2d right = Eigen::Vector2d::Zero();

  /// Of a point: how far past the line, crossed along the driving direction.
  double Past(const Eigen::Vector2d& point) const;
  /// Of a point: true if it lies between the ends, or no farther than `margin` beyond one.
  bool Spans(const Eigen::Vector2d& point, double margin) const;
};

/// Through the large orange cones ahead of the map's start (pose zero), at most 30 m away; empty
/// where the map holds none on one of the sides.
std::optional<MapGate> FindMapGate(const std::vector<GlobalCone>& cones);

}  // namespace hairpin
