#include "daemons/lidar_driver/velodyne_decoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr size_t kPacketSize = 1206;
constexpr size_t kBlocks = 12;
constexpr size_t kReturns = 32;
constexpr size_t kReturnSize = 3;
constexpr size_t kBlockSize = 4 + kReturns * kReturnSize;
constexpr size_t kTimeOffset = kBlocks * kBlockSize;
constexpr size_t kModeOffset = kTimeOffset + 4;
constexpr size_t kProductOffset = kTimeOffset + 5;
constexpr uint16_t kFlag = 0xeeff;  // 0xff 0xee on the wire
constexpr uint8_t kStrongest = 0x37;
constexpr uint8_t kLast = 0x38;
constexpr uint8_t kDual = 0x39;
constexpr int kFullTurn = 36000;           // 0.01 deg
constexpr double kMaxDuration = 0.2;       // s: a turn of the slowest head
constexpr int kMaxBlockTurn = 200;         // twice what the fastest head turns in the longest block
constexpr uint32_t kHour = 3'600'000'000;  // us
constexpr size_t kOusterSize = 12608;      // of an Ouster OS1's 16 columns of 64 pixels
constexpr double kHundredthsPerRadian = 18000.0 / std::numbers::pi;

uint16_t Read16(const uint8_t* data) { return static_cast<uint16_t>(data[0] | data[1] << 8); }

uint32_t Read32(const uint8_t* data) {
  return Read16(data) | static_cast<uint32_t>(Read16(data + 2)) << 16;
}

int AzimuthOf(const uint8_t* block) { return Read16(block + 2); }

struct SinCos {
  float sin;
  float cos;
};

std::vector<SinCos> MakeTable() {
  std::vector<SinCos> table(kFullTurn);
  for (int i = 0; i < kFullTurn; ++i) {
    const double angle = i / kHundredthsPerRadian;
    table[static_cast<size_t>(i)] = {static_cast<float>(std::sin(angle)),
                                     static_cast<float>(std::cos(angle))};
  }
  return table;
}

// Of an angle in 0.01 deg, between -1 and 2 turns: the table's nearest entry, turned by the rest,
// which is below 1e-4 rad, so that the first order is exact to the float's last bit.
SinCos SinCosOf(float hundredths) {
  static const std::vector<SinCos> kTable = MakeTable();
  const float shifted = hundredths + static_cast<float>(kFullTurn);  // positive: rounds by cutting
  // Positive, and lround is a call.
  const int nearest = static_cast<int>(shifted + 0.5f);  // NOLINT(bugprone-incorrect-roundings)
  const float rest =
      (shifted - static_cast<float>(nearest)) * static_cast<float>(1.0 / kHundredthsPerRadian);
  const SinCos entry = kTable[static_cast<size_t>(nearest % kFullTurn)];
  return {entry.sin + entry.cos * rest, entry.cos - entry.sin * rest};
}

// From a block to the one `stride` after it.
int TurnOf(const uint8_t* block, size_t stride) {
  return (AzimuthOf(block + stride * kBlockSize) - AzimuthOf(block) + kFullTurn) % kFullTurn;
}

// The mean of those turns within a packet that are no jumps; 0 where there is none.
double MeanTurn(const uint8_t* packet, size_t stride) {
  int sum = 0;
  int count = 0;
  for (size_t block = 0; block + stride < kBlocks; block += stride) {
    const int turn = TurnOf(packet + block * kBlockSize, stride);
    if (turn > kMaxBlockTurn) continue;
    sum += turn;
    ++count;
  }
  return count == 0 ? 0.0 : static_cast<double>(sum) / count;
}

size_t ColumnStride(uint8_t mode) { return mode == kDual ? 2 : 1; }

}  // namespace

std::string_view NameOf(Refusal refusal) {
  constexpr std::array<std::string_view, kNumRefusals> kNames{
      "sender", "size", "model", "return mode", "flag", "azimuth", "time", "frozen"};
  return kNames.at(static_cast<size_t>(refusal));
}

VelodyneDecoder::VelodyneDecoder(const VelodyneParams& params)
    : model_([&]() -> const VelodyneModel& {
        const VelodyneModel* model = FindVelodyneModel(params.model);
        if (model == nullptr) throw std::invalid_argument("VelodyneDecoder: no " + params.model);
        return *model;
      }()) {
  const LidarCalibration& calibration = params.calibration;
  const size_t channels = model_.firings.size();
  if (calibration.elevation.size() != channels || calibration.azimuth_offset.size() != channels)
    throw std::invalid_argument("VelodyneDecoder: calibration of another number of lasers");
  if (!(params.min_range >= 0.0 && params.max_range > params.min_range))
    throw std::invalid_argument("VelodyneDecoder: ranges must be 0 <= min_range < max_range");
  min_distance_ = std::max(1, static_cast<int>(std::ceil(params.min_range / model_.distance_step)));
  max_distance_ =
      static_cast<int>(std::min(65535.0, std::floor(params.max_range / model_.distance_step)));

  std::vector<size_t> by_elevation(channels);
  std::iota(by_elevation.begin(), by_elevation.end(), size_t{0});
  std::stable_sort(by_elevation.begin(), by_elevation.end(), [&](size_t a, size_t b) {
    return calibration.elevation[a] < calibration.elevation[b];
  });
  std::vector<uint8_t> rings(channels);
  for (size_t ring = 0; ring < channels; ++ring) {
    rings[by_elevation[ring]] = static_cast<uint8_t>(ring);
    ring_elevations_.push_back(static_cast<float>(calibration.elevation[by_elevation[ring]]));
  }
  const double block_period =
      model_.sequence_period * static_cast<double>(model_.sequences_per_block());
  for (size_t i = 0; i < kReturns; ++i) {
    const size_t channel = i % channels;
    const size_t sequence = i / channels;
    const double elevation = calibration.elevation[channel];
    const double offset = calibration.azimuth_offset[channel];
    if (!(std::abs(elevation) < 2.0 && std::abs(offset) < 2.0))
      throw std::invalid_argument("VelodyneDecoder: angles must be finite and below 2 rad");
    const double time =
        static_cast<double>(sequence) * model_.sequence_period + model_.firings[channel];
    lasers_.push_back(
        {static_cast<float>(std::cos(elevation)), static_cast<float>(std::sin(elevation)),
         static_cast<float>(offset * kHundredthsPerRadian), static_cast<float>(time / block_period),
         static_cast<float>(time), rings[channel]});
  }
}

bool VelodyneDecoder::IsDataSize(size_t size) const { return size == kPacketSize; }

std::optional<Refused> VelodyneDecoder::Problem(std::span<const uint8_t> packet) const {
  if (packet.size() != kPacketSize) {
    const std::string bytes = std::to_string(packet.size()) + " bytes";
    if (packet.size() == kOusterSize)
      return Refused{Refusal::kModel, "packet of an Ouster OS1 (" + bytes + "), not of a " +
                                          std::string(model_.name)};
    return Refused{Refusal::kSize, "packet of " + bytes};
  }
  const uint8_t product = packet[kProductOffset];
  if (product != model_.product_id)
    return Refused{Refusal::kModel, "packet of a Velodyne " +
                                        std::string(VelodyneProductName(product)) +
                                        " (product id " + std::to_string(product) + "), not of a " +
                                        std::string(model_.name)};
  const uint8_t mode = packet[kModeOffset];
  if (mode != kStrongest && mode != kLast && mode != kDual)
    return Refused{Refusal::kReturnMode, "return mode " + std::to_string(mode)};
  if (Read32(&packet[kTimeOffset]) >= kHour)
    return Refused{Refusal::kTime, "time stamp beyond the hour"};
  const size_t stride = ColumnStride(mode);
  for (size_t block = 0; block < kBlocks; ++block) {
    const uint8_t* data = &packet[block * kBlockSize];
    if (Read16(data) != kFlag)
      return Refused{Refusal::kFlag, "no flag in block " + std::to_string(block)};
    const int azimuth = AzimuthOf(data);
    if (azimuth >= kFullTurn)
      return Refused{Refusal::kAzimuth, "azimuth " + std::to_string(azimuth)};
    if (block % stride != 0 && azimuth != AzimuthOf(data - kBlockSize))
      return Refused{Refusal::kAzimuth, "two azimuths for one pair of returns"};
  }
  return std::nullopt;
}

std::optional<Refused> VelodyneDecoder::Decode(std::span<const uint8_t> packet,
                                               DecodedPacket& decoded) const {
  if (auto problem = Problem(packet)) return problem;
  decoded.columns.clear();
  decoded.points.clear();
  decoded.time_us = Read32(&packet[kTimeOffset]);
  const size_t stride = ColumnStride(packet[kModeOffset]);
  const size_t sequences = model_.sequences_per_block();
  const double block_period = model_.sequence_period * static_cast<double>(sequences);
  const double mean_turn = MeanTurn(packet.data(), stride);
  decoded.column_turn = mean_turn / static_cast<double>(sequences);
  double time = 0.0;
  for (size_t block = 0; block < kBlocks; block += stride) {
    const uint8_t* data = &packet[block * kBlockSize];
    // The last block turns like the others, and so does one before a jump.
    const int step = block + stride < kBlocks ? TurnOf(data, stride) : kFullTurn;
    const bool jumps = step > kMaxBlockTurn;
    DecodeBlock(data, stride == 2 ? data + kBlockSize : nullptr,
                static_cast<float>(AzimuthOf(data)), static_cast<float>(jumps ? mean_turn : step),
                static_cast<float>(time), decoded);
    decoded.duration = time + static_cast<double>(lasers_.back().time);
    time += jumps && mean_turn > 0.0 ? block_period * step / mean_turn : block_period;
  }
  // A head that hardly turns would take for ever to where a jump ends.
  if (decoded.duration > kMaxDuration)
    return Refused{Refusal::kAzimuth, "azimuths of a packet too far apart"};
  return std::nullopt;
}

void VelodyneDecoder::DecodeBlock(const uint8_t* block, const uint8_t* twin, float azimuth,
                                  float turn, float time, DecodedPacket& decoded) const {
  const size_t channels = model_.firings.size();
  for (size_t i = 0; i < kReturns; ++i) {
    const size_t offset = 4 + i * kReturnSize;
    const float fired_azimuth = azimuth + turn * lasers_[i].turn;
    DecodeReturn(block + offset, lasers_[i], fired_azimuth, time, decoded);
    // Of a lone echo the sensor may send two copies.
    if (twin != nullptr && Read16(twin + offset) != Read16(block + offset))
      DecodeReturn(twin + offset, lasers_[i], fired_azimuth, time, decoded);
    if ((i + 1) % channels != 0) continue;
    const float first = azimuth + turn * lasers_[i + 1 - channels].turn;
    decoded.columns.push_back({static_cast<int>(first) % kFullTurn,
                               time + lasers_[i + 1 - channels].time, decoded.points.size()});
  }
}

void VelodyneDecoder::DecodeReturn(const uint8_t* data, const Laser& laser, float azimuth,
                                   float time, DecodedPacket& decoded) const {
  const int distance = Read16(data);
  if (distance < min_distance_ || distance > max_distance_) return;
  const float range = static_cast<float>(distance) * static_cast<float>(model_.distance_step);
  const SinCos angle = SinCosOf(azimuth + laser.azimuth_offset);
  const float level = range * laser.cos_elevation;
  decoded.points.push_back({{level * angle.cos, -level * angle.sin, range * laser.sin_elevation},
                            data[2],
                            laser.ring,
                            time + laser.time});
}

}  // namespace hairpin
