#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/report/run_log.hpp"
#include "tools/report/svg.hpp"

namespace hairpin {

// Each picture takes a run and its report (EvaluateRun), whose track, seed and build it names.
// Where the log lacks what it shows, the picture stays empty but whole.

/// "track FSG19, seed 1, build 0123abc", and the faults injected.
std::string Provenance(const nlohmann::json& report);

/// The track from above: true cones, mapped cones after alignment, the driven line coloured by
/// speed, boundaries and paths of a few moments, and where cones were hit or the car left the
/// course. Turned so that it is wider than high.
Svg DrawTrack(const RunLog& log, const nlohmann::json& report);

/// True and commanded speed over the distance driven, on a background that tells the map mode.
Svg DrawSpeed(const RunLog& log, const nlohmann::json& report);

/// Distance of the car from its path, over the distance driven.
Svg DrawLateralError(const RunLog& log, const nlohmann::json& report);

/// The paper's two planning histograms, this run's bars beside the paper's.
Svg DrawPathLengths(const nlohmann::json& report);
Svg DrawOutOfTrack(const nlohmann::json& report);

}  // namespace hairpin
