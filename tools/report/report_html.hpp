#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/report/run_log.hpp"

namespace hairpin {

/// The page for people, whole in itself: no scripts, no other files, readable by day, by night and
/// on paper. `report` is EvaluateRun()'s, of the same log.
std::string ReportPage(const nlohmann::json& report, const RunLog& log);

/// Writes `report.json`, `report.html` and its pictures as `track.svg`, `speed.svg`,
/// `lateral_error.svg`, `path_length.svg`, `out_of_track.svg` into a folder that exists. Throws
/// std::runtime_error where it cannot write.
void WriteReport(const std::string& out_dir, const nlohmann::json& report, const RunLog& log);

}  // namespace hairpin
