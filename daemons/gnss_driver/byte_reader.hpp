#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

namespace hairpin {

using Bytes = std::span<const uint8_t>;

/// A little-endian integer at `offset`. Throws std::out_of_range past the end.
template <class Integer>
Integer LittleEndian(Bytes bytes, size_t offset) {
  if (offset + sizeof(Integer) > bytes.size()) throw std::out_of_range("past the end");
  uint64_t value = 0;
  for (size_t i = 0; i < sizeof(Integer); ++i)
    value |= static_cast<uint64_t>(bytes[offset + i]) << (8 * i);
  return static_cast<Integer>(value);
}

}  // namespace hairpin
