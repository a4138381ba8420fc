#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemons/global_mapper/global_mapper.hpp"
#include "daemons/global_mapper/journal.hpp"

namespace hairpin {

struct MapStoreParams {
  std::string directory;  // empty: nothing is kept
  double resume_within =
      0.0;  // s of data time: a journal that ended longer ago is of another drive, > 0
  int64_t max_journal_bytes = 0;  // > 0
};

/// Where the map lies between two lives of the daemon, and after the drive: `journal` while it is
/// made, `map.yaml` once the loop is closed and after each lap; `place` holds the car's place in a
/// known map.
class MapStore {
 public:
  explicit MapStore(const MapStoreParams& params);

  /// Before the first local map, of time `utime`, goes into `mapper`: replays the journal if it is
  /// of this drive, else begins a new one. Returns the records replayed.
  size_t Resume(int64_t utime, GlobalMapper& mapper);
  void Keep(const GlobalMapper::Outcome& outcome, int64_t session);

  /// What went wrong since the last call, a line for people; empty mostly.
  std::string TakeProblem();
  std::string map_file() const { return params_.directory + "/map.yaml"; }

 private:
  void Save(const GlobalMapper::Outcome& outcome, int64_t session);

  MapStoreParams params_;
  std::unique_ptr<Journal> journal_;
  std::string problem_;
  bool journal_failed_ = false;
};

}  // namespace hairpin
