#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace hairpin {

/// One message of an event log.
struct LogEvent {
  int64_t number = 0;        // as the log counts it
  int64_t timestamp_us = 0;  // when it was recorded
  std::string channel;
  std::vector<uint8_t> data;
};

/// The bounds of one event: LCM names no longer channel, no sensor of the car sends more at once.
inline constexpr size_t kMaxLogChannelBytes = 63;
inline constexpr size_t kMaxLogDataBytes = size_t{64} << 20;
/// Every event begins with this word, big-endian like all numbers of the format.
inline constexpr uint32_t kLogSyncWord = 0xEDA1DA01u;

/// Reads LCM event logs from first to last, the damaged ones too: where LCM's own reader stops at
/// the first event that is corrupt, this one goes on at the next sync word that begins a sound
/// event. Memory is bounded by the largest event.
///
/// An event is sound if its channel and lengths are within the bounds above, it lies within the
/// file, and it is followed by another sync word or by the end of the file; where the next event's
/// sync word is damaged, it is enough that the event holds no sync word inside, for then its length
/// has swallowed no other.
class LogReader {
 public:
  /// Throws std::runtime_error where the file cannot be opened.
  explicit LogReader(const std::string& path);

  /// The next sound event; empty at the end of the log. Throws std::runtime_error where the disk
  /// fails.
  std::optional<LogEvent> Next();

  /// Bytes so far that belonged to no sound event.
  int64_t skipped_bytes() const { return skipped_bytes_; }

 private:
  bool Fill(size_t size);
  const uint8_t* At(size_t offset) const { return buffer_.data() + begin_ + offset; }
  bool SkipToSyncWord();
  void Skip(size_t size);
  std::optional<LogEvent> ParseEvent();
  bool IsWhole(size_t size);

  std::string path_;
  std::ifstream file_;
  int64_t unread_bytes_ = 0;     // of the file, beyond the buffer
  std::vector<uint8_t> buffer_;  // a window of the file
  size_t begin_ = 0;             // of what is not yet consumed
  int64_t skipped_bytes_ = 0;
};

}  // namespace hairpin
