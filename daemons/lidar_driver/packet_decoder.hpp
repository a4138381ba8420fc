#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/lidar_scan.hpp"

namespace hairpin {

/// Why a packet was not used.
enum class Refusal {
  kSender,      // not from the sensor's address
  kSize,        // no packet of this maker
  kModel,       // of another model
  kReturnMode,  // one that is not understood
  kFlag,        // a block that does not begin as one
  kAzimuth,     // beyond the circle, or turning in a way that no head does
  kTime,        // beyond the hour
  kFrozen,      // time or azimuth does not advance: the same packet again, or a late one
  kCount
};
inline constexpr size_t kNumRefusals = static_cast<size_t>(Refusal::kCount);
using RefusalCounts = std::array<int64_t, kNumRefusals>;

std::string_view NameOf(Refusal refusal);

/// A refusal and, for people, its details.
struct Refused {
  Refusal reason;
  std::string what;
};

/// All lasers' returns of one position of the head.
struct Column {
  int azimuth;  // of the head at its first firing, clockwise from x [0.01 deg], 0 to 35999
  float time;   // of that firing, from the packet's first one [s]
  size_t end;   // one past its last point in DecodedPacket::points
};

/// What one data packet says.
struct DecodedPacket {
  uint32_t time_us = 0;      // of the first firing, past the hour on the sensor's clock
  double duration = 0.0;     // to the last firing [s]
  double column_turn = 0.0;  // of the head between two columns, on average [0.01 deg]
  std::vector<Column> columns;
  std::vector<LidarPoint> points;  // in the order of firing; `age` is here the time since the first
                                   // firing of the packet [s]
};

/// Understands one maker's data packets. Neither reads past the packet, whatever it holds.
class PacketDecoder {
 public:
  virtual ~PacketDecoder() = default;
  /// Whether a payload of this size may be a data packet; others are for the position decoder.
  virtual bool IsDataSize(size_t size) const = 0;
  /// Overwrites `decoded`, whose memory is used again. Returns why not, where it cannot be used;
  /// `decoded` is then unspecified.
  virtual std::optional<Refused> Decode(std::span<const uint8_t> packet,
                                        DecodedPacket& decoded) const = 0;
  virtual std::string_view model() const = 0;
  /// By ring number, rising [rad].
  virtual const std::vector<float>& ring_elevations() const = 0;
  /// Time between the firings of one ring [s].
  virtual double column_period() const = 0;
};

}  // namespace hairpin
