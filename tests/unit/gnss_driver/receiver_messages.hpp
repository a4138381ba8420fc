#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace hairpin {

/// Writes little-endian at an offset.
template <class Integer>
void Put(std::vector<uint8_t>& bytes, size_t offset, Integer value) {
  for (size_t i = 0; i < sizeof(Integer); ++i)
    bytes[offset + i] = static_cast<uint8_t>(static_cast<uint64_t>(value) >> (8 * i));
}

/// 2026-11-24 12:35:19 UTC and a place in Switzerland.
struct PvtFields {
  uint32_t time_of_week_ms = 217'919'000;
  int32_t nano = 0;
  uint8_t flags = 0x01;
  uint8_t valid = 0x07;
};

/// A NAV-PVT payload by the interface description's table, not by the decoder.
inline std::vector<uint8_t> PvtPayload(const PvtFields& fields) {
  std::vector<uint8_t> bytes(92);
  Put(bytes, 0, fields.time_of_week_ms);
  Put(bytes, 4, uint16_t{2026});
  bytes[6] = 11;
  bytes[7] = 24;
  bytes[8] = 12;
  bytes[9] = 35;
  bytes[10] = 19;
  bytes[11] = fields.valid;
  Put(bytes, 16, fields.nano);
  bytes[20] = 3;
  bytes[21] = fields.flags;
  Put(bytes, 24, int32_t{86'481'304});
  Put(bytes, 28, int32_t{473'961'067});
  Put(bytes, 32, int32_t{488'000});
  Put(bytes, 40, uint32_t{14});
  Put(bytes, 44, uint32_t{20});
  Put(bytes, 48, int32_t{-2'000});
  Put(bytes, 52, int32_t{10'000});
  Put(bytes, 56, int32_t{-500});
  Put(bytes, 68, uint32_t{50});
  return bytes;
}

inline std::vector<uint8_t> RelPosNedPayload(uint32_t time_of_week_ms, double heading_deg,
                                             double accuracy_deg) {
  std::vector<uint8_t> bytes(64);
  bytes[0] = 1;
  Put(bytes, 4, time_of_week_ms);
  Put(bytes, 24, static_cast<int32_t>(std::lround(heading_deg * 1e5)));
  Put(bytes, 36, uint32_t{77});  // accuracy to the north, 0.1 mm
  Put(bytes, 52, static_cast<uint32_t>(std::lround(accuracy_deg * 1e5)));
  Put(bytes, 60, uint32_t{0x105});
  return bytes;
}

}  // namespace hairpin
