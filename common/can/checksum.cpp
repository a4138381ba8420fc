#include "common/can/checksum.hpp"

#include <algorithm>
#include <array>

namespace hairpin {

uint8_t Crc8(const uint8_t* data, size_t size) {
  unsigned crc = 0xFF;
  for (size_t i = 0; i < size; ++i) {
    crc ^= data[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1 ^ ((crc & 0x80u) != 0 ? 0x1Du : 0u)) & 0xFFu;
  }
  return static_cast<uint8_t>(crc ^ 0xFFu);
}

uint8_t ProtectionOf(const CanFrame& frame) {
  std::array<uint8_t, 10> bytes{};
  bytes[0] = static_cast<uint8_t>(frame.id);
  bytes[1] = static_cast<uint8_t>(frame.id >> 8);
  const size_t covered = std::min<size_t>(frame.length, frame.data.size());
  std::copy_n(frame.data.begin(), covered, bytes.begin() + 2);
  return Crc8(bytes.data(), covered == 0 ? 2 : covered + 1);
}

}  // namespace hairpin
