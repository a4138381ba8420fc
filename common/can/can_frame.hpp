#pragma once

#include <array>
#include <cstdint>

namespace hairpin {

/// A classic CAN frame. `id` has the flags of Linux's can_id in its upper bits.
struct CanFrame {
  static constexpr uint32_t kExtended = 0x8000'0000u;  // 29-bit identifier
  static constexpr uint32_t kRemote = 0x4000'0000u;
  static constexpr uint32_t kError = 0x2000'0000u;

  uint32_t id = 0;
  uint8_t length = 0;  // 0 to 8
  std::array<uint8_t, 8> data{};

  bool operator==(const CanFrame&) const = default;
};

}  // namespace hairpin
