#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/can/can_frame.hpp"

namespace hairpin {

/// Most frames that one datagram of ours carries: 5 + 90 * 13 bytes stay under an Ethernet frame.
inline constexpr size_t kMaxCannelloniFrames = 90;

/// A datagram of cannelloni's public UDP format, version 2: version, operation (0: data), sequence
/// number, count of frames (16 bits); for each frame its can_id (32 bits), length, and data; all
/// big-endian. Remote frames have a length, but no data. Throws std::invalid_argument for more than
/// kMaxCannelloniFrames.
std::vector<uint8_t> EncodeCannelloni(uint8_t sequence, std::span<const CanFrame> frames);

struct CannelloniDatagram {
  uint8_t sequence = 0;
  std::vector<CanFrame> frames;
};

/// Empty where the bytes are no data of that format to the last byte, or carry CAN FD.
std::optional<CannelloniDatagram> DecodeCannelloni(std::span<const uint8_t> bytes);

}  // namespace hairpin
