#pragma once

#include <cstddef>
#include <cstdint>

#include "common/can/can_frame.hpp"

namespace hairpin {

/// CRC-8 SAE J1850: polynomial 0x1D, start 0xFF, final xor 0xFF. Of "123456789": 0x4B.
uint8_t Crc8(const uint8_t* data, size_t size);

/// What the last byte of a protected frame holds: Crc8 over the identifier (two bytes,
/// little-endian) and all other bytes, so that a frame under a wrong identifier does not pass.
uint8_t ProtectionOf(const CanFrame& frame);

}  // namespace hairpin
