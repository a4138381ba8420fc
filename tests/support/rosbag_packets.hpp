#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace hairpin {

struct RecordedPacket {
  int64_t utime;
  std::vector<uint8_t> bytes;
};

/// Reads little-endian CDR, in which a number stands at a multiple of its own size.
class CdrReader {
 public:
  explicit CdrReader(std::vector<uint8_t> bytes) : bytes_(std::move(bytes)) {}
  uint32_t U32() {
    at_ = (at_ + 3) / 4 * 4;
    uint32_t value = 0;
    std::memcpy(&value, Take(4), 4);
    return value;
  }
  std::vector<uint8_t> Array(size_t size) {
    const uint8_t* data = Take(size);
    return {data, data + size};
  }

 private:
  const uint8_t* Take(size_t size) {
    if (kHeader + at_ + size > bytes_.size()) throw std::runtime_error("CDR message breaks off");
    at_ += size;
    return bytes_.data() + kHeader + at_ - size;
  }
  static constexpr size_t kHeader = 4;  // names the encoding; positions count from its end
  std::vector<uint8_t> bytes_;
  size_t at_ = 0;
};

/// The packets of the velodyne_msgs/VelodyneScan messages of a rosbag2 file, scan by scan.
inline std::vector<std::vector<RecordedPacket>> ReadVelodyneScans(const std::string& path) {
  sqlite3* opened = nullptr;
  const std::string uri = "file:" + path + "?immutable=1";
  const int code =
      sqlite3_open_v2(uri.c_str(), &opened, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> database(opened, sqlite3_close);
  sqlite3_stmt* prepared = nullptr;
  if (code != SQLITE_OK ||
      sqlite3_prepare_v2(opened, "SELECT data FROM messages ORDER BY timestamp", -1, &prepared,
                         nullptr) != SQLITE_OK)
    throw std::runtime_error(path + ": " + sqlite3_errmsg(opened));
  const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> rows(prepared, sqlite3_finalize);
  std::vector<std::vector<RecordedPacket>> scans;
  while (sqlite3_step(prepared) == SQLITE_ROW) {
    const auto* data = static_cast<const uint8_t*>(sqlite3_column_blob(prepared, 0));
    CdrReader reader({data, data + sqlite3_column_bytes(prepared, 0)});
    reader.U32();  // header: seconds, nanoseconds, frame
    reader.U32();
    reader.Array(reader.U32());
    std::vector<RecordedPacket>& scan = scans.emplace_back();
    for (uint32_t left = reader.U32(); left > 0; --left) {
      const int64_t seconds = reader.U32();
      const int64_t nanoseconds = reader.U32();
      scan.push_back({seconds * 1'000'000 + nanoseconds / 1000, reader.Array(1206)});
    }
  }
  return scans;
}

}  // namespace hairpin
