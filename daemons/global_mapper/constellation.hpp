#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "common/cone.hpp"
#include "common/geometry.hpp"

namespace hairpin {

struct ConstellationPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // m
  ConeColour colour = ConeColour::kUnknown;
};

struct ConstellationParams {
  double tolerance = 0.0;             // m between partners, > 0
  double max_translation = 0.0;       // m of the points' centre from the guess, > 0
  double max_rotation = 0.0;          // rad from the guess, > 0
  size_t min_pairs = 0;               // >= 3
  size_t min_lead = 0;                // pairs more than the next best place has, >= 1
  double contradiction_weight = 0.0;  // of a pair whose colours contradict, 0 (none is) to 1

  /// Throws std::invalid_argument naming parameter, relation and bound.
  void Validate() const;
};

struct ConstellationMatch {
  Pose2 T_to_from;
  std::vector<std::pair<size_t, size_t>> pairs;  // (from, to), each point once
  double rmse = 0.0;                             // m
  // Sum over the pairs of weight * (1 - (distance / tolerance)^2), less the penalty [Torr 2000,
  // MSAC].
  double score = 0.0;
};

/// False for two colours that contradict each other; unknown contradicts none, and the two sizes of
/// orange not each other.
bool AreCompatible(ConeColour a, ConeColour b);

/// How improbable a place is before anything was compared, in pairs that it must have more: of two
/// places with odds of e^3 to 1, the pairs being worth as much each, one.
using PlacePenalty = std::function<double(const Pose2& T_to_from)>;

/// Finds the place of a group of cones among others by its shape, whatever the drift within the
/// bounds: every pair of cones is tried on every pair of equal distance, and the rigid motion that
/// most cones agree with is refined in closed form. Empty where too few agree, or where another
/// place, a cone spacing away say, is nearly as good: equally spaced cones along a straight look
/// alike everywhere.
std::optional<ConstellationMatch> MatchConstellation(const std::vector<ConstellationPoint>& from,
                                                     const std::vector<ConstellationPoint>& to,
                                                     const Pose2& guess,
                                                     const ConstellationParams& params,
                                                     const PlacePenalty& penalty = {});

}  // namespace hairpin
