#pragma once

#include <cstddef>
#include <cstdint>

namespace hairpin {

/// CRC-32C of `size` bytes (Castagnoli polynomial, reflected, initial value and final xor all ones)
/// [RFC 3720, 12.1]. Eight bytes a step: by the processor's instruction where it has one (SSE 4.2),
/// else by tables [Kounavis and Berry 2005, "slicing-by-8"].
uint32_t Crc32c(const uint8_t* data, size_t size);

/// The same by tables, whatever the processor has.
uint32_t Crc32cByTables(const uint8_t* data, size_t size);

}  // namespace hairpin
