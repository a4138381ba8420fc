#pragma once

#include <cmath>
#include <cstdint>

namespace hairpin::dbc {

/// Closed interval of a signal's physical value.
struct Range {
  double min;
  double max;
};

/// Little-endian signals in a payload of at most 8 bytes, taken as one number whose byte 0 is the
/// lowest. `start` and `length` are those of the DBC; `length` is 1 to 64.
constexpr uint64_t SignalMask(int length) { return ~uint64_t{0} >> (64 - length); }

constexpr uint64_t InsertBits(uint64_t raw, int start, int length) {
  return (raw & SignalMask(length)) << start;
}

constexpr uint64_t ExtractUnsigned(uint64_t bits, int start, int length) {
  return bits >> start & SignalMask(length);
}

constexpr int64_t ExtractSigned(uint64_t bits, int start, int length) {
  const uint64_t sign = uint64_t{1} << (length - 1);
  return static_cast<int64_t>((ExtractUnsigned(bits, start, length) ^ sign) - sign);
}

/// physical = raw * factor + offset, to the nearest raw value.
inline uint64_t ToRaw(double physical, double factor, double offset) {
  return static_cast<uint64_t>(std::llround((physical - offset) / factor));
}

template <class Raw>
double ToPhysical(Raw raw, double factor, double offset) {
  return static_cast<double>(raw) * factor + offset;
}

}  // namespace hairpin::dbc
