#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/report/run_log.hpp"

namespace hairpin {

/// The referee's verdict.
struct LapResult {
  bool finished = false;
  std::optional<double> time_s;  // of all laps together, without penalties
  int cones_hit = 0;
  int off_course = 0;
  std::optional<double> max_speed_mps;
  std::optional<double> mean_speed_mps;
  std::string reason;  // for people: why it ended
  std::vector<double> lap_times_s;
};

/// What the log does not say about its run.
struct RunContext {
  int64_t seed = 0;
  std::string track;
  std::string build;
  std::vector<std::string> faults;  // as injected, in words
  std::optional<double> real_time_factor;
  LapResult lap;
  std::map<std::string, std::vector<double>> latency_ms;  // samples by stage
};

/// All figures of the run under the keys of DESIGN section 7 (tools/drive) and some more. What
/// could not be computed is null. The same log and context give the same object.
nlohmann::json EvaluateRun(const RunLog& log, const RunContext& context);

}  // namespace hairpin
