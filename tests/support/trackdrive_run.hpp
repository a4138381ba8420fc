#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/support/race_run.hpp"

namespace hairpin {

/// An autocross lap of the default track, and the map that it left; driven once in a program.
struct MappedTrack {
  TemporaryFolder folder;
  RaceRun autocross =
      RunInProcess(DefaultTrackFile(), 1, {}, {"global_mapper.files.directory=" + folder.File("")});
};

inline const MappedTrack& DefaultTrackMapped() {
  static const std::unique_ptr<const MappedTrack> track = std::make_unique<MappedTrack>();
  return *track;
}

/// A trackdrive of `laps` on that map, by another seed.
inline RaceRun RunTrackdrive(int laps, const std::vector<std::string>& faults = {},
                             std::vector<std::string> overrides = {}) {
  for (const std::string& override :
       {"global_mapper.files.known_map=" + DefaultTrackMapped().folder.File("map.yaml"),
        std::string("simulator.race_control.mission=3"),
        "simulator.referee.laps=" + std::to_string(laps),
        "mission_manager.trackdrive_laps=" + std::to_string(laps)})
    overrides.push_back(override);
  return RunInProcess(DefaultTrackFile(), 2, faults, overrides);
}

}  // namespace hairpin
