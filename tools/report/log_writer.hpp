#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "common/channels.hpp"

namespace hairpin {

/// Writes an LCM event log, which lcm-logplayer and LogReader read: the same calls make the same
/// bytes. What is written reaches the file at the latest after 64 KiB or one second of timestamps,
/// so a process that dies loses no more than that.
class LogWriter {
 public:
  /// Replaces the file. Throws std::runtime_error where it cannot be written.
  explicit LogWriter(const std::string& path);
  /// Writes what is left, and cannot say whether that succeeded: Close() can.
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Appends one event. Throws std::invalid_argument for a channel or data beyond the format's
  /// bounds (log_reader.hpp), std::logic_error after Close(), std::runtime_error where the disk is
  /// full.
  void Write(int64_t timestamp_us, std::string_view channel, const uint8_t* data, size_t size);

  /// The same of a message.
  template <class M>
  void Write(int64_t timestamp_us, const Channel<M>& channel, const M& message) {
    std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    Write(timestamp_us, channel.name, bytes.data(), bytes.size());
  }

  /// Flushes and closes; a second call does nothing. Throws std::runtime_error where not everything
  /// could be written.
  void Close();

  int64_t events() const { return events_; }

 private:
  void Append(uint64_t value, size_t size);
  void Flush();

  std::string path_;
  std::ofstream file_;
  std::vector<uint8_t> buffer_;
  int64_t events_ = 0;
  int64_t first_buffered_us_ = 0;  // timestamp of the oldest event that is still in the buffer
};

}  // namespace hairpin
