#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemons/global_mapper/map_record.hpp"

namespace hairpin {

/// What a journal holds up to the first record that is torn or wrong.
struct JournalContents {
  std::vector<MapRecord> records;
  int64_t good_bytes = 0;
  int64_t bad_bytes = 0;  // behind them
};

/// Reads what is there; nothing where there is no file.
JournalContents ReadJournal(const std::string& file);

/// The map's records on disk, each with its length and CRC32C, so that a map survives its mapper.
/// Records go to the operating system as they come, and to the disk once a second of data time. A
/// disk that fails costs the journal, not the map: `problem()` says what happened, and nothing more
/// is written.
class Journal {
 public:
  /// `max_bytes`: beyond it nothing is written.
  Journal(std::string file, int64_t max_bytes);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Begins an empty one in place of what is there.
  void Start();
  /// Goes on behind the first `good_bytes` of what is there.
  void Continue(int64_t good_bytes);
  void Append(const std::vector<MapRecord>& records, int64_t utime);

  /// Why nothing is written any more; empty while all is well.
  const std::string& problem() const { return problem_; }

 private:
  void Open(int flags, int64_t size);
  void Fail(const std::string& what);
  bool Write(const std::vector<uint8_t>& bytes);

  std::string file_;
  int64_t max_bytes_;
  int descriptor_ = -1;
  int64_t size_ = 0;
  int64_t synced_utime_ = 0;
  std::string problem_;
};

}  // namespace hairpin
