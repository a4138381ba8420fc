#include "daemons/global_mapper/journal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>

#include "common/crc32c.hpp"
#include "daemons/global_mapper/record_codec.hpp"

namespace hairpin {
namespace {

constexpr uint32_t kMagic = 0x4a4d5048;     // "HPMJ"
constexpr size_t kHeaderBytes = 12;         // magic, length, CRC32C of the payload; little-endian
constexpr int64_t kSyncPeriod = 1'000'000;  // us of data time

uint32_t Word(const uint8_t* bytes) {
  uint32_t word = 0;
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

void Put(uint32_t word, std::vector<uint8_t>& bytes) {
  const auto* begin = reinterpret_cast<const uint8_t*>(&word);
  bytes.insert(bytes.end(), begin, begin + sizeof word);
}

}  // namespace

JournalContents ReadJournal(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> chars{std::istreambuf_iterator<char>(stream), {}};
  std::span<const uint8_t> rest(reinterpret_cast<const uint8_t*>(chars.data()), chars.size());
  JournalContents contents;
  while (rest.size() >= kHeaderBytes) {
    const size_t size = Word(rest.data() + 4);
    if (Word(rest.data()) != kMagic || size > rest.size() - kHeaderBytes) break;
    const auto payload = rest.subspan(kHeaderBytes, size);
    if (Crc32c(payload.data(), payload.size()) != Word(rest.data() + 8)) break;
    auto record = DecodeMapRecord(payload);
    if (!record) break;
    contents.records.push_back(std::move(*record));
    rest = rest.subspan(kHeaderBytes + size);
  }
  contents.bad_bytes = static_cast<int64_t>(rest.size());
  contents.good_bytes = static_cast<int64_t>(chars.size()) - contents.bad_bytes;
  return contents;
}

Journal::Journal(std::string file, int64_t max_bytes)
    : file_(std::move(file)), max_bytes_(max_bytes) {}

Journal::~Journal() {
  if (descriptor_ >= 0) close(descriptor_);
}

void Journal::Open(int flags, int64_t size) {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | flags, 0644);
  if (descriptor_ < 0) return Fail("cannot be opened");
  size_ = size;
  if (ftruncate(descriptor_, size) != 0 || lseek(descriptor_, size, SEEK_SET) != size)
    Fail("cannot be truncated");
}

void Journal::Start() { Open(O_TRUNC, 0); }

void Journal::Continue(int64_t good_bytes) { Open(0, good_bytes); }

void Journal::Fail(const std::string& what) {
  problem_ = file_ + ": " + what + (errno != 0 ? std::string(": ") + std::strerror(errno) : "");
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
}

bool Journal::Write(const std::vector<uint8_t>& bytes) {
  size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t count = write(descriptor_, bytes.data() + written, bytes.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    written += static_cast<size_t>(count);
  }
  size_ += static_cast<int64_t>(written);
  return true;
}

void Journal::Append(const std::vector<MapRecord>& records, int64_t utime) {
  if (descriptor_ < 0 || records.empty()) return;
  std::vector<uint8_t> bytes;
  for (const MapRecord& record : records) {
    const std::vector<uint8_t> payload = Encode(record);
    Put(kMagic, bytes);
    Put(static_cast<uint32_t>(payload.size()), bytes);
    Put(Crc32c(payload.data(), payload.size()), bytes);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
  }
  errno = 0;
  if (size_ + static_cast<int64_t>(bytes.size()) > max_bytes_) return Fail("has reached its bound");
  if (!Write(bytes)) return Fail("cannot be written");
  if (utime - synced_utime_ < kSyncPeriod) return;
  synced_utime_ = utime;
  if (fdatasync(descriptor_) != 0) Fail("cannot be synced");
}

}  // namespace hairpin
