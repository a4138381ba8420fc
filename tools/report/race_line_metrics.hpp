#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/report/run_log.hpp"

namespace hairpin {

/// How the race line was driven, while driving and where there was one (else null): share of the
/// commands that followed it, how often it was left for TRACK, how far from it the car was while on
/// it (as the controller saw it), and how it believed to stand against the truth: RMS and worst of
/// the localisation's error, less its mean offset at the first line, whose frame is the map's own.
nlohmann::json RaceLineJson(const RunLog& log);

/// Stretches of the race line for one lap, placed by the true pose of their times: map of the truth
/// [m].
std::vector<std::vector<Eigen::Vector2d>> RaceLineOfALap(const RunLog& log);

}  // namespace hairpin
