#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "common/cone.hpp"
#include "common/geometry.hpp"
#include "tools/report/run_log.hpp"

namespace hairpin {

/// A map cone counts once it was held for certain: this existence, seen this often.
inline constexpr double kCertainExistence = 0.8;
inline constexpr int kCertainObservations = 5;
/// A map cone nearer than this to a true one is that cone [m].
inline constexpr double kMatchGate = 1.0;

/// Its most probable class.
ConeColour ColourOf(const local_cone_t& cone);
ConeColour ColourOf(const global_cone_t& cone);

/// The rigid T_to_from that takes the points of `from` to their partners in `to` with the least sum
/// of squares, in closed form [Arun 1987]. Empty for fewer than two pairs or where all coincide, so
/// that the turn is open. Throws std::invalid_argument where the sizes differ.
std::optional<Pose2> AlignRigidly(const std::vector<Eigen::Vector2d>& from,
                                  const std::vector<Eigen::Vector2d>& to);

/// T_to_from by iterative closest points [Besl 1992] from `guess` on. Pairs farther apart than a
/// gate are left out; it shrinks from 3 m to kMatchGate. `guess` comes back where there is too
/// little to align.
Pose2 AlignByIcp(const std::vector<Eigen::Vector2d>& from, const std::vector<Eigen::Vector2d>& to,
                 const Pose2& guess);

struct ComparedCone {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // map, aligned [m]
  ConeColour colour = ConeColour::kUnknown;
  std::optional<size_t> match;  // index of the true cone within the gate
  double distance = 0.0;        // to the nearest true cone [m]
};

/// The map of the run against the true cones [paper IV-B, Table II].
struct MapComparison {
  std::map<int64_t, Pose2>
      T_map_local;  // of local maps, by epoch of the mapper: each has a local frame of its own
  std::vector<ComparedCone> cones;
  int matched = 0;  // true cones that a map cone lies at
  int missed = 0;   // true cones without one
  int false_cones = 0;
  int doubled =
      0;  // map cones at a true cone that has a nearer one: drift, seen again at the end of the lap
  std::optional<double> rmse;   // of all map cones within the gate, the doubled ones too [m]
  std::optional<double> worst;  // of the same [m]
};

/// A cone of some map, in that map's frame.
struct EstimatedCone {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // m
  ConeColour colour = ConeColour::kUnknown;
};

/// Cones of one map against true ones after one rigid alignment, found from `guess` (T_truth_map)
/// on.
MapComparison CompareCones(const std::vector<EstimatedCone>& cones,
                           const std::vector<Eigen::Vector2d>& truth, const Pose2& guess);

/// The run's last global map. Empty where no track, true pose or global map is known.
std::optional<MapComparison> CompareGlobalMap(const RunLog& log);

/// All cones of the run's local maps, in the state last published, under one rigid alignment for
/// the whole run: the drift of dead reckoning stays in the figures. Empty where no track, true pose
/// or local map is known.
std::optional<MapComparison> CompareLocalMaps(const RunLog& log);

/// The global map where the run has one, else the local maps.
std::optional<MapComparison> CompareMap(const RunLog& log);

/// The keys of `map`; null where there is nothing to compare.
nlohmann::json ToJson(const std::optional<MapComparison>& comparison);

}  // namespace hairpin
