#include "tools/simulator/lidar/velodyne_encoder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr size_t kBlocks = 12;
constexpr size_t kChannels = 32;
constexpr size_t kBlockSize = 4 + 3 * kChannels;
constexpr double kRangeStep = 0.004;  // m
constexpr int64_t kHour = 3'600'000'000;
constexpr uint8_t kStrongest = 0x37;
constexpr uint8_t kVlp32c = 0x28;
constexpr uint8_t kPpsLocked = 2;

void Put(uint8_t* bytes, uint64_t value, size_t size) {
  for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<uint8_t>(value >> (8 * i));
}

uint64_t Azimuth(double radians) {
  const long hundredths = std::lround(radians * 18000.0 / std::numbers::pi);
  return static_cast<uint64_t>(hundredths % 36000);
}

}  // namespace

std::optional<VelodyneDataPacket> VelodyneEncoder::Add(const FiringSequence& sequence) {
  if (sequence.returns.size() != kChannels)
    throw std::invalid_argument("a VLP-32C packet takes 32 returns a sequence");
  if (blocks_ == 0) {
    const int64_t first_us = epoch_us_ + sequence.start_ns / 1000;
    Put(packet_.data() + kBlocks * kBlockSize, static_cast<uint64_t>(first_us % kHour), 4);
    packet_[1204] = kStrongest;
    packet_[1205] = kVlp32c;
  }
  uint8_t* block = packet_.data() + blocks_ * kBlockSize;
  block[0] = 0xff;
  block[1] = 0xee;
  Put(block + 2, Azimuth(sequence.azimuth_rad), 2);
  for (size_t channel = 0; channel < kChannels; ++channel) {
    const LidarReturn& echo = sequence.returns[channel];
    Put(block + 4 + 3 * channel, static_cast<uint64_t>(std::lround(echo.range / kRangeStep)), 2);
    block[6 + 3 * channel] = echo.range > 0.0f ? ReflectivityByte(echo.reflectivity) : uint8_t{0};
  }
  if (++blocks_ < kBlocks) return std::nullopt;
  blocks_ = 0;
  return packet_;
}

VelodynePositionPacket EncodeVelodynePosition(int64_t utime_us) {
  VelodynePositionPacket packet{};
  Put(packet.data() + 198, static_cast<uint64_t>(utime_us % kHour), 4);
  packet[202] = kPpsLocked;
  const std::time_t seconds = utime_us / 1'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char date[16];
  char time[16];
  std::strftime(time, sizeof time, "%H%M%S", &utc);
  std::strftime(date, sizeof date, "%d%m%y", &utc);
  char body[96];  // a place of no meaning: positions come from the car's own receiver
  std::snprintf(body, sizeof body, "GPRMC,%s,A,4930.0000,N,00834.0000,E,000.0,000.0,%s,,,A", time,
                date);
  unsigned checksum = 0;
  for (const char* letter = body; *letter != '\0'; ++letter)
    checksum ^= static_cast<unsigned char>(*letter);
  char sentence[128];
  const int length = std::snprintf(sentence, sizeof sentence, "$%s*%02X\r\n", body, checksum);
  std::copy(sentence, sentence + length, packet.begin() + 206);
  return packet;
}

}  // namespace hairpin
