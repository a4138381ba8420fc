#pragma once

#include <optional>

#include "daemons/boundary_estimator/stretch.hpp"

namespace hairpin {

struct OneSidedParams {
  double min_spacing = 0.0;    // m; nearer cones are one and the same mark, as at the start gate
  double max_spacing = 0.0;    // m; between consecutive cones of a side
  double max_turn = 0.0;       // rad; of the side at one cone
  double min_log_ratio = 0.0;  // log p_assigned - log p_max that a cone of the side may have
  double max_jump =
      0.0;  // m; where the first gate is farther from the car, one side alone leads to it
  double log_penalty = 0.0;    // of a path that rests on one side alone, against those with two
  double default_width = 0.0;  // m; of the track, until one was seen
};

/// Throws std::invalid_argument naming the parameter, the relation and the bound.
void Check(const OneSidedParams& params);

enum class Side { kLeft, kRight };

/// The track along the cones of one side, followed cone by cone from the nearest one ahead of the
/// car; the other side is inferred `width` away. Empty where no cone is near enough or sure enough
/// to begin with.
Stretch FollowSideFromCar(const Scene& scene, Side side, double width,
                          const OneSidedParams& params);

/// Goes on past the end of `stretch` along the side whose cones lead farther, with the other
/// inferred `width` away. Not for an empty stretch.
void ContinueOnOneSide(const Scene& scene, double width, const OneSidedParams& params,
                       Stretch& stretch);

/// Where the first gate is far from the car, puts before it the gates of `one_sided`, if its cones
/// lead to that gate.
void FillJump(const Stretch& one_sided, const OneSidedParams& params, Stretch& stretch);

}  // namespace hairpin
