#pragma once

#include "daemons/global_mapper/race_line/corridor.hpp"

namespace hairpin {

struct MinimumCurvatureParams {
  int max_iterations = 0;  // >= 1
  double max_step = 0.0;   // sideways in one iteration [m], > 0
  double tolerance = 0.0;  // done when no point moves by more [m], > 0
};

/// The closed line through the corridor whose squared curvature, integrated over its length, is
/// least [Heilmeier et al. 2019, "Minimum curvature trajectory planning and control for an
/// autonomous race car", section 3].
///
/// Points p_i of the present line move along their normals by a_i. To first order the curvature
/// becomes k_i + a_i'' + k_i^2 a_i and the length ds (1 - k_i a_i), so that one iteration is the
/// quadratic programme
///
///     min over a  of  sum (k_i + a_i'' + k_i^2 a_i)^2 - k_i^3 a_i,   right_i <= a_i <= left_i
///
/// whose fixed point, a = 0, is a stationary point of the true integral. The room left and right is
/// measured anew from the moved line, with the width that the car's body sweeps at its curvature.
/// Throws std::invalid_argument for parameters out of their bounds.
ClosedCurve MinimumCurvatureLine(const Corridor& corridor, const MinimumCurvatureParams& params);

}  // namespace hairpin
