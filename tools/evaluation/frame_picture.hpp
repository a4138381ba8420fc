#pragma once

#include <string>

#include "tools/evaluation/planner_evaluation.hpp"

namespace hairpin {

/// An SVG picture of what the boundary estimator saw and chose in one frame: cones by colour,
/// boundaries and middle path (dashed where extrapolated), and behind them the driven line and the
/// final map's sides. North is up.
std::string DrawFrame(const std::vector<RecordedFrame>& run, size_t frame,
                      const PlannerFrame& result);

}  // namespace hairpin
