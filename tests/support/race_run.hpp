#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"
#include "tools/race/race.hpp"
#include "tools/report/run_log.hpp"

namespace hairpin {

/// Where recordings of real cars and competition tracks lie; they are not in the project.
inline std::filesystem::path DataFolder() {
  const char* named = std::getenv("HAIRPIN_DATA");
  return named != nullptr ? std::filesystem::path(named)
                          : std::filesystem::path(HAIRPIN_SOURCE_DIR) / ".." / "shared" / "data";
}

inline std::string DefaultTrackFile() {
  return std::string(HAIRPIN_SOURCE_DIR) + "/config/tracks/default.yaml";
}

struct RaceRun {
  RaceOutcome outcome;
  RunLog log;
  std::string bytes;  // of the log file
};

/// One race in this process, as `tools/drive --in-process` runs it; `can`: with --can.
inline RaceRun RunInProcess(const std::string& track_file, uint64_t seed,
                            const std::vector<std::string>& faults = {},
                            const std::vector<std::string>& overrides = {},
                            SensorLevel level = SensorLevel::kCones, bool can = false) {
  const TemporaryFolder folder;
  RaceOptions options;
  options.track = LoadTrack(track_file);
  options.seed = seed;
  options.in_process = true;
  if (can) options.can = kCannelloni;
  options.speed = 0.0;
  for (const std::string& text : faults)
    options.faults.push_back(ParseFault(text, FaultSources(level, can)));
  options.stack.config_dir = std::string(HAIRPIN_SOURCE_DIR) + "/config";
  options.stack.overrides = overrides;
  options.stack.level = level;
  options.log_file = folder.File("log.lcmlog");
  const int never = 0;
  RaceRun run;
  run.outcome = RunRace(options, never);
  run.log = LoadRunLog(options.log_file);
  std::ifstream stream(options.log_file, std::ios::binary);
  run.bytes.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  return run;
}

/// Time of the first AS Driving; 0 if there is none.
inline int64_t GoTime(const RunLog& log) {
  for (const as_state_t& state : log.as_states) {
    if (state.state == as_state_t::STATE_DRIVING) return state.utime;
  }
  return 0;
}

}  // namespace hairpin
