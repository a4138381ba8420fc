#include "tools/evaluation/recorded_scans.hpp"

#include <lzma.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>

#include "tools/evaluation/recording_error.hpp"

namespace hairpin {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr size_t kHeaderBytes = 4 + 7 * sizeof(double) + sizeof(uint32_t);
constexpr uint64_t kMaxDecoderMemory = uint64_t{256} << 20;
constexpr float kMillimetre = 1e-3f;

template <class T>
T Read(const uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

std::vector<float> Metres(const uint8_t* bytes, size_t n) {
  std::vector<float> metres(n);
  for (size_t i = 0; i < n; ++i)
    metres[i] = static_cast<float>(Read<int16_t>(bytes + 2 * i)) * kMillimetre;
  return metres;
}

}  // namespace

class RecordedScanReader::Decompressor {
 public:
  explicit Decompressor(const std::string& file) : stream_(file, std::ios::binary) {
    if (!stream_) throw RecordingError(file + ": cannot be read");
    if (lzma_stream_decoder(&lzma_, kMaxDecoderMemory, 0) != LZMA_OK)
      throw RecordingError(file + ": the decoder of xz cannot start");
  }
  ~Decompressor() { lzma_end(&lzma_); }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  /// Reads up to `size` bytes; fewer only at the end. Empty where the file is no xz or damaged.
  std::optional<size_t> Read(uint8_t* out, size_t size) {
    lzma_.next_out = out;
    lzma_.avail_out = size;
    while (lzma_.avail_out > 0 && !finished_) {
      if (lzma_.avail_in == 0 && stream_) {
        stream_.read(reinterpret_cast<char*>(packed_.data()),
                     static_cast<std::streamsize>(packed_.size()));
        lzma_.next_in = packed_.data();
        lzma_.avail_in = static_cast<size_t>(stream_.gcount());
      }
      const lzma_ret result = lzma_code(&lzma_, stream_ ? LZMA_RUN : LZMA_FINISH);
      if (result == LZMA_STREAM_END) {
        finished_ = true;
      } else if (result != LZMA_OK) {
        return std::nullopt;
      }
    }
    return size - lzma_.avail_out;
  }

 private:
  std::ifstream stream_;
  lzma_stream lzma_ = LZMA_STREAM_INIT;
  std::array<uint8_t, 65536> packed_{};
  bool finished_ = false;
};

RecordedScanReader::RecordedScanReader(const std::string& file)
    : file_(file), bytes_(std::make_unique<Decompressor>(file)) {}

RecordedScanReader::~RecordedScanReader() = default;

void RecordedScanReader::Fail(const std::string& why) const {
  throw RecordingError(file_ + ": scan " + std::to_string(scans_) + ": " + why);
}

std::optional<RecordedScan> RecordedScanReader::Next() {
  std::array<uint8_t, kHeaderBytes> header{};
  const std::optional<size_t> got = bytes_->Read(header.data(), header.size());
  if (!got) Fail("the xz stream is damaged");
  if (*got == 0) return std::nullopt;
  if (*got < header.size()) Fail("is cut off");
  if (std::memcmp(header.data(), "FSCN", 4) != 0) Fail("does not begin with FSCN");
  std::array<double, 7> values{};
  for (size_t i = 0; i < values.size(); ++i) {
    values[i] = Read<double>(header.data() + 4 + i * sizeof(double));
    if (!std::isfinite(values[i])) Fail("a number of the header is not finite");
  }
  const auto n = Read<uint32_t>(header.data() + 4 + values.size() * sizeof(double));
  if (n > kMaxPoints) Fail("has " + std::to_string(n) + " points");
  if (scans_ > 0 && values[0] <= last_time_) Fail("time does not increase");

  std::vector<uint8_t> body(size_t{7} * n);
  if (bytes_->Read(body.data(), body.size()) != body.size()) Fail("is cut off or damaged");
  RecordedScan scan;
  scan.time = values[0];
  scan.T_map_base = {values[1], values[2], values[3]};
  scan.velocity = {values[4], values[5], values[6]};
  scan.x = Metres(body.data(), n);
  scan.y = Metres(body.data() + 2 * size_t{n}, n);
  scan.z = Metres(body.data() + 4 * size_t{n}, n);
  scan.intensity.assign(body.begin() + 6 * static_cast<ptrdiff_t>(n), body.end());
  last_time_ = scan.time;
  ++scans_;
  return scan;
}

std::vector<SurveyedCone> LoadSurveyedMap(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw RecordingError(file + ": cannot be read");
  std::string line;
  std::getline(stream, line);
  if (line.substr(0, line.find('\r')) != "x_m,y_m,colour")
    throw RecordingError(file + ": the header must be x_m,y_m,colour");
  std::vector<SurveyedCone> map;
  for (int number = 2; std::getline(stream, line); ++number) {
    std::istringstream fields(line);
    double x = 0.0, y = 0.0;
    char comma_x = 0, comma_y = 0;
    std::string name;
    fields >> x >> comma_x >> y >> comma_y >> name;
    const std::optional<ConeColour> colour = ConeColourFromName(name);
    if (!fields || comma_x != ',' || comma_y != ',' || !std::isfinite(x) || !std::isfinite(y) ||
        !colour)
      throw RecordingError(file + ": line " + std::to_string(number) + ": must be x,y,colour");
    map.push_back({{x, y}, *colour});
  }
  return map;
}

}  // namespace hairpin
