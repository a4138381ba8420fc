#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/race/race.hpp"
#include "tools/report/run_metrics.hpp"

namespace hairpin {

/// True if the mission was finished, no cone hit and the car never off course.
bool IsClean(const RaceResult& result);

/// What the report needs to know beyond the log.
RunContext ToContext(const RaceOptions& options, const RaceOutcome& outcome);

/// Adds to a trackdrive's report the autocross that made its map: `autocross.{lap,map,seed}`, and
/// `speed_ratio`, the trackdrive's mean speed over the autocross'.
void AddAutocross(const nlohmann::json& autocross, nlohmann::json& trackdrive);

/// The result as a person reads it at the end of a run, a few lines.
std::string Summary(const nlohmann::json& report, const std::string& out_dir);

/// logs_dir/TIME_TRACK_SEED.
std::string DefaultOutDir(const std::string& logs_dir, const std::string& track, uint64_t seed);

}  // namespace hairpin
