#include "tools/report/log_reader.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr size_t kSyncBytes = 4;
constexpr size_t kHeaderBytes = 28;  // sync word, number, timestamp, channel length, data length
constexpr size_t kChunkBytes = size_t{1} << 18;
constexpr std::array<uint8_t, kSyncBytes> kSync{kLogSyncWord >> 24, (kLogSyncWord >> 16) & 0xff,
                                                (kLogSyncWord >> 8) & 0xff, kLogSyncWord & 0xff};

uint64_t BigEndian(const uint8_t* bytes, size_t size) {
  uint64_t value = 0;
  for (size_t i = 0; i < size; ++i) value = value << 8 | bytes[i];
  return value;
}

const uint8_t* FindSync(const uint8_t* begin, const uint8_t* end) {
  return std::search(begin, end, kSync.begin(), kSync.end());
}

bool IsPrintable(uint8_t byte) { return byte > 0x20 && byte < 0x7f; }

}  // namespace

LogReader::LogReader(const std::string& path)
    : path_(path), file_(path, std::ios::binary | std::ios::ate) {
  const std::streamoff size = file_ ? static_cast<std::streamoff>(file_.tellg()) : -1;
  if (size < 0 || !file_.seekg(0)) throw std::runtime_error(path + ": cannot be read");
  unread_bytes_ = size;
}

std::optional<LogEvent> LogReader::Next() {
  while (SkipToSyncWord()) {
    if (auto event = ParseEvent()) return event;
    Skip(1);
  }
  return std::nullopt;
}

/// Makes `size` bytes stand in the buffer. False where the file has no more.
bool LogReader::Fill(size_t size) {
  const size_t held = buffer_.size() - begin_;
  if (held >= size) return true;
  if (size - held > static_cast<uint64_t>(unread_bytes_)) return false;
  const size_t wanted =
      std::min(std::max(size - held, kChunkBytes), static_cast<size_t>(unread_bytes_));
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
  begin_ = 0;
  buffer_.resize(held + wanted);
  file_.read(reinterpret_cast<char*>(buffer_.data() + held), static_cast<std::streamsize>(wanted));
  if (static_cast<size_t>(file_.gcount()) != wanted)
    throw std::runtime_error(path_ + ": reading failed");
  unread_bytes_ -= static_cast<int64_t>(wanted);
  return true;
}

void LogReader::Skip(size_t size) {
  begin_ += size;
  skipped_bytes_ += static_cast<int64_t>(size);
}

bool LogReader::SkipToSyncWord() {
  while (Fill(kSyncBytes)) {
    const uint8_t* end = buffer_.data() + buffer_.size();
    const uint8_t* found = FindSync(At(0), end);
    // The last bytes of the window may begin a sync word that the next one completes.
    if (found == end) found = end - (kSyncBytes - 1);
    const bool is_sync = static_cast<size_t>(end - found) >= kSyncBytes;
    Skip(static_cast<size_t>(found - At(0)));
    if (is_sync) return true;
  }
  Skip(buffer_.size() - begin_);
  return false;
}

/// The event at the window's begin, which is consumed then; empty, and nothing consumed, where it
/// is not sound.
std::optional<LogEvent> LogReader::ParseEvent() {
  if (!Fill(kHeaderBytes)) return std::nullopt;
  const size_t channel_size = BigEndian(At(20), 4);
  const size_t data_size = BigEndian(At(24), 4);
  if (channel_size == 0 || channel_size > kMaxLogChannelBytes || data_size > kMaxLogDataBytes)
    return std::nullopt;
  const size_t size = kHeaderBytes + channel_size + data_size;
  if (!Fill(size) || !IsWhole(size)) return std::nullopt;
  const uint8_t* channel = At(kHeaderBytes);
  const uint8_t* data = channel + channel_size;
  if (!std::all_of(channel, data, IsPrintable)) return std::nullopt;
  LogEvent event{static_cast<int64_t>(BigEndian(At(4), 8)),
                 static_cast<int64_t>(BigEndian(At(12), 8)), std::string(channel, data),
                 std::vector<uint8_t>(data, data + data_size)};
  begin_ += size;
  return event;
}

bool LogReader::IsWhole(size_t size) {
  if (!Fill(size + kSyncBytes)) {
    if (buffer_.size() - begin_ == size && unread_bytes_ == 0) return true;
  } else if (std::equal(kSync.begin(), kSync.end(), At(size))) {
    return true;
  }
  return FindSync(At(kSyncBytes), At(size)) == At(size);
}

}  // namespace hairpin
