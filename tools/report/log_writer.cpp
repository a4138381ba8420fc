#include "tools/report/log_writer.hpp"

#include <stdexcept>

#include "common/clock.hpp"
#include "tools/report/log_reader.hpp"

namespace hairpin {
namespace {

constexpr size_t kFlushBytes = size_t{1} << 16;
constexpr double kFlushInterval = 1.0;  // s of timestamps

}  // namespace

LogWriter::LogWriter(const std::string& path)
    : path_(path), file_(path, std::ios::binary | std::ios::trunc) {
  if (!file_) throw std::runtime_error(path + ": cannot be written");
}

LogWriter::~LogWriter() {
  try {
    Close();
  } catch (const std::runtime_error&) {
    // A destructor has nobody to tell.
  }
}

void LogWriter::Write(int64_t timestamp_us, std::string_view channel, const uint8_t* data,
                      size_t size) {
  if (!file_.is_open()) throw std::logic_error(path_ + ": is closed");
  if (channel.empty() || channel.size() > kMaxLogChannelBytes || size > kMaxLogDataBytes) {
    throw std::invalid_argument(path_ + ": no event: channel '" + std::string(channel) + "' with " +
                                std::to_string(size) + " bytes");
  }
  if (buffer_.empty()) first_buffered_us_ = timestamp_us;
  Append(kLogSyncWord, 4);
  Append(static_cast<uint64_t>(events_++), 8);
  Append(static_cast<uint64_t>(timestamp_us), 8);
  Append(channel.size(), 4);
  Append(size, 4);
  buffer_.insert(buffer_.end(), channel.begin(), channel.end());
  buffer_.insert(buffer_.end(), data, data + size);
  if (buffer_.size() >= kFlushBytes ||
      SecondsBetween(first_buffered_us_, timestamp_us) >= kFlushInterval)
    Flush();
}

void LogWriter::Close() {
  if (!file_.is_open()) return;
  Flush();
  file_.close();
  if (!file_) throw std::runtime_error(path_ + ": closing failed");
}

void LogWriter::Append(uint64_t value, size_t size) {
  for (size_t i = size; i-- > 0;) buffer_.push_back(static_cast<uint8_t>(value >> (8 * i)));
}

void LogWriter::Flush() {
  file_.write(reinterpret_cast<const char*>(buffer_.data()),
              static_cast<std::streamsize>(buffer_.size()));
  buffer_.clear();
  if (!file_.flush()) throw std::runtime_error(path_ + ": writing failed");
}

}  // namespace hairpin
