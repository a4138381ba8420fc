#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/map_mode.hpp"
#include "tools/report/run_log.hpp"

namespace hairpin {

/// From `utime` on, PIPELINE_STATUS says `mode`.
struct ModeChange {
  int64_t utime = 0;
  MapMode mode = MapMode::kUnknown;
  std::string cause;
  /// Data time since the newest message of the pipeline that was lost [s]: what the reaction took.
  /// Of the longest silent one where several were lost at once, empty where none was.
  std::optional<double> reaction;
};

/// The mode in force at the Go (at the log's begin where there was none), and every change after
/// it.
std::vector<ModeChange> ModeChanges(const RunLog& log);

/// List of {"t_s", "mode", "cause", "reaction_s"}; t_s counts from the Go, null where there was
/// none.
nlohmann::json ToJson(const std::vector<ModeChange>& changes, std::optional<int64_t> go_utime);

}  // namespace hairpin
