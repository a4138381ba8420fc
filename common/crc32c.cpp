#include "common/crc32c.hpp"

#include <array>
#include <cstring>

#ifdef __x86_64__
#include <nmmintrin.h>
#endif

namespace hairpin {
namespace {

constexpr uint32_t kPolynomial = 0x82f63b78u;  // 0x1edc6f41, bits reversed
constexpr size_t kSlices = 8;

using Tables = std::array<std::array<uint32_t, 256>, kSlices>;

// tables[k][b]: what byte b leaves in the remainder, once k more bytes have followed it.
constexpr Tables MakeTables() {
  Tables tables{};
  for (uint32_t byte = 0; byte < 256; ++byte) {
    uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0 ? crc >> 1 ^ kPolynomial : crc >> 1;
    tables[0][byte] = crc;
  }
  for (size_t slice = 1; slice < kSlices; ++slice) {
    for (size_t byte = 0; byte < 256; ++byte) {
      const uint32_t crc = tables[slice - 1][byte];
      tables[slice][byte] = crc >> 8 ^ tables[0][crc & 0xffu];
    }
  }
  return tables;
}

constexpr Tables kTables = MakeTables();

constexpr uint32_t Word(const uint8_t* data) {
  return uint32_t{data[0]} | uint32_t{data[1]} << 8 | uint32_t{data[2]} << 16 |
         uint32_t{data[3]} << 24;
}

constexpr uint32_t Lookup(size_t slice, uint32_t word) {
  return kTables[slice][word & 0xffu] ^ kTables[slice - 1][word >> 8 & 0xffu] ^
         kTables[slice - 2][word >> 16 & 0xffu] ^ kTables[slice - 3][word >> 24];
}

#ifdef __x86_64__
__attribute__((target("sse4.2"))) uint32_t ByInstruction(const uint8_t* data, size_t size) {
  uint64_t crc = 0xffffffffu;
  for (; size >= sizeof crc; data += sizeof crc, size -= sizeof crc) {
    uint64_t word;
    std::memcpy(&word, data, sizeof word);
    crc = _mm_crc32_u64(crc, word);
  }
  auto rest = static_cast<uint32_t>(crc);
  for (; size > 0; ++data, --size) rest = _mm_crc32_u8(rest, *data);
  return ~rest;
}

bool HasInstruction() {
  static const bool has = __builtin_cpu_supports("sse4.2") != 0;
  return has;
}
#endif

}  // namespace

uint32_t Crc32c(const uint8_t* data, size_t size) {
#ifdef __x86_64__
  if (HasInstruction()) return ByInstruction(data, size);
#endif
  return Crc32cByTables(data, size);
}

uint32_t Crc32cByTables(const uint8_t* data, size_t size) {
  uint32_t crc = 0xffffffffu;
  for (; size >= kSlices; data += kSlices, size -= kSlices)
    crc = Lookup(7, Word(data) ^ crc) ^ Lookup(3, Word(data + 4));
  for (; size > 0; ++data, --size) crc = crc >> 8 ^ kTables[0][(crc ^ *data) & 0xffu];
  return ~crc;
}

}  // namespace hairpin
