#include "common/can/cannelloni.hpp"

#include <algorithm>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr uint8_t kVersion = 2;
constexpr uint8_t kData = 0;
constexpr size_t kHeaderSize = 5;
constexpr size_t kFrameHeaderSize = 5;

bool HasData(const CanFrame& frame) { return (frame.id & CanFrame::kRemote) == 0; }

// Takes the frame at the front of `bytes` off; false where there is none.
bool TakeFrame(std::span<const uint8_t>& bytes, CanFrame& frame) {
  if (bytes.size() < kFrameHeaderSize) return false;
  frame.id = uint32_t{bytes[0]} << 24 | uint32_t{bytes[1]} << 16 | uint32_t{bytes[2]} << 8 |
             uint32_t{bytes[3]};
  frame.length = bytes[4];  // CAN FD's flag is its upper bit: too long for us
  bytes = bytes.subspan(kFrameHeaderSize);
  if (frame.length > frame.data.size()) return false;
  const size_t size = HasData(frame) ? frame.length : 0;
  if (bytes.size() < size) return false;
  std::copy_n(bytes.begin(), size, frame.data.begin());
  bytes = bytes.subspan(size);
  return true;
}

}  // namespace

std::vector<uint8_t> EncodeCannelloni(uint8_t sequence, std::span<const CanFrame> frames) {
  if (frames.size() > kMaxCannelloniFrames)
    throw std::invalid_argument("more CAN frames than a datagram takes");
  std::vector<uint8_t> bytes{kVersion, kData, sequence, 0, static_cast<uint8_t>(frames.size())};
  for (const CanFrame& frame : frames) {
    for (int shift = 24; shift >= 0; shift -= 8)
      bytes.push_back(static_cast<uint8_t>(frame.id >> shift));
    bytes.push_back(frame.length);
    if (HasData(frame))
      bytes.insert(bytes.end(), frame.data.begin(), frame.data.begin() + frame.length);
  }
  return bytes;
}

std::optional<CannelloniDatagram> DecodeCannelloni(std::span<const uint8_t> bytes) {
  if (bytes.size() < kHeaderSize || bytes[0] != kVersion || bytes[1] != kData) return std::nullopt;
  CannelloniDatagram datagram;
  datagram.sequence = bytes[2];
  const size_t count = size_t{bytes[3]} << 8 | bytes[4];
  bytes = bytes.subspan(kHeaderSize);
  if (count * kFrameHeaderSize > bytes.size()) return std::nullopt;  // before anything is allocated
  datagram.frames.resize(count);
  for (CanFrame& frame : datagram.frames) {
    if (!TakeFrame(bytes, frame)) return std::nullopt;
  }
  if (!bytes.empty()) return std::nullopt;
  return datagram;
}

}  // namespace hairpin
