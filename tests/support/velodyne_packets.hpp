#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace hairpin {

using Bytes = std::vector<uint8_t>;

inline void Put(Bytes& bytes, size_t offset, uint64_t value, size_t size) {
  for (size_t i = 0; i < size; ++i) bytes[offset + i] = static_cast<uint8_t>(value >> (8 * i));
}

/// Packets as a Velodyne sensor sends them, written from the manual and not with the decoder's
/// code: a head that turns at 10 Hz and sees the same distance everywhere.
struct VelodyneSource {
  uint8_t product = 0x28;        // VLP-32C
  uint8_t mode = 0x37;           // strongest
  uint32_t time_us = 0;          // of the next packet's first firing, past the hour
  double azimuth = 0.0;          // of its first block [0.01 deg]
  double block_turn = 19.90656;  // 55.296 us at 10 Hz [0.01 deg]
  double block_period_us = 55.296;
  uint16_t distance = 2500;  // 10 m in steps of 4 mm

  /// The next packet.
  Bytes Next() {
    Bytes packet(1206, 0);
    for (size_t block = 0; block < 12; ++block) {
      const bool twin = mode == 0x39 && block % 2 == 1;
      packet[100 * block] = 0xff;
      packet[100 * block + 1] = 0xee;
      Put(packet, 100 * block + 2, static_cast<uint64_t>(azimuth) % 36000, 2);
      for (size_t i = 0; i < 32; ++i) {
        Put(packet, 100 * block + 4 + 3 * i, distance + (twin ? 250u : 0u), 2);
        packet[100 * block + 6 + 3 * i] = static_cast<uint8_t>(i);
      }
      if (mode == 0x39 && !twin) continue;
      azimuth += block_turn;
      if (azimuth >= 36000.0) azimuth -= 36000.0;
      elapsed_us_ += block_period_us;
    }
    Put(packet, 1200, time_us, 4);
    packet[1204] = mode;
    packet[1205] = product;
    Skip();
    return packet;
  }

  /// Time since the first packet goes on by what the blocks took, rounded as the sensor's does.
  void Skip() {
    const auto whole = static_cast<uint32_t>(elapsed_us_);
    time_us = (time_us + whole) % 3'600'000'000u;
    elapsed_us_ -= whole;
  }

 private:
  double elapsed_us_ = 0.0;
};

/// A position packet; `rmc` without "$" and checksum.
inline Bytes VelodynePosition(uint32_t time_us, const std::string& rmc, uint8_t pps = 2) {
  Bytes packet(512, 0);
  Put(packet, 198, time_us, 4);
  packet[202] = pps;
  unsigned checksum = 0;
  for (const char letter : rmc) checksum ^= static_cast<unsigned char>(letter);
  char tail[8];
  std::snprintf(tail, sizeof tail, "*%02X\r\n", checksum);
  const std::string sentence = "$" + rmc + tail;
  std::copy(sentence.begin(), sentence.end(), packet.begin() + 206);
  return packet;
}

}  // namespace hairpin
