#pragma once

#include <cstdint>

namespace hairpin {

/// Times on the bus are the lower 16 bits of car time in units of 100 us: they wrap after 6.5536 s.
inline constexpr int64_t kSampleTimeMicros = 100;

/// `utime` as it stands in a frame, rounded down to the unit.
inline uint16_t ToSampleTime(int64_t utime) {
  return static_cast<uint16_t>(utime / kSampleTimeMicros);
}

/// The utime nearest to `reference_utime` that has this sample time: right if the two are less than
/// 3.2768 s apart.
inline int64_t FromSampleTime(uint16_t sample_time, int64_t reference_utime) {
  const int64_t reference = reference_utime / kSampleTimeMicros;
  const auto difference =
      static_cast<int16_t>(static_cast<uint16_t>(sample_time - static_cast<uint16_t>(reference)));
  return (reference + difference) * kSampleTimeMicros;
}

}  // namespace hairpin
