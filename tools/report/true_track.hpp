#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/cone.hpp"
#include "hairpin/truth_track_t.hpp"

namespace hairpin {

struct TrueCone {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // map [m]
  ConeColour colour = ConeColour::kUnknown;
};

/// The cones that stand on the track, clutter left out; those of the boundaries whether or not the
/// list repeats them.
std::vector<TrueCone> TrueCones(const truth_track_t& track);
/// What stands beside it and is no cone. map [m]
std::vector<Eigen::Vector2d> Clutter(const truth_track_t& track);

/// What lies between the two boundaries, map [m].
class TrackBand {
 public:
  /// A closed track's boundaries are loops. An open one goes on straight for 30 m before its first
  /// and past its last cones, where nothing says that it ends.
  explicit TrackBand(const truth_track_t& track);

  /// By the winding number: where a track crosses or touches itself, it still is on it.
  bool Contains(const Eigen::Vector2d& point) const;

  /// Closed polygons whose winding numbers sum to other than 0 on the track: one, or left and
  /// reversed right loop.
  const std::vector<std::vector<Eigen::Vector2d>>& rings() const { return rings_; }

 private:
  std::vector<std::vector<Eigen::Vector2d>> rings_;
};

}  // namespace hairpin
