#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "daemons/lidar_driver/packet_decoder.hpp"
#include "daemons/lidar_driver/revolution.hpp"
#include "daemons/lidar_driver/sensor_clock.hpp"

namespace hairpin {

/// One UDP payload, as it came.
struct LidarPacket {
  std::span<const uint8_t> payload;
  int64_t receive_utime = 0;       // host's clock
  std::optional<uint32_t> sender;  // IPv4 address, host byte order; none where there is no network
};

struct LidarDriverParams {
  SensorClockParams clock;
  RevolutionParams revolution;
  std::optional<uint32_t> sensor_address;  // IPv4, host byte order; none: any sender
};

/// What became of one packet.
struct LidarDriverResult {
  std::optional<Revolution> revolution;  // that it completed
  std::optional<Refused> refused;
};

/// From a rotating LiDAR's packets to revolutions with time, whatever else the network brings.
class LidarDriver {
 public:
  /// Throws as RevolutionAssembler does.
  LidarDriver(const LidarDriverParams& params, std::unique_ptr<const PacketDecoder> decoder);

  /// A data or a position packet, told apart by their size.
  LidarDriverResult Add(const LidarPacket& packet);

  const RefusalCounts& refused() const { return refused_; }
  int64_t used() const { return used_; }
  int64_t given_up() const { return revolutions_.given_up(); }
  /// Of the newest used packet's first firing; empty before the time is known.
  std::optional<int64_t> utime() const { return clock_.utime(); }
  TimeSource time_source() const { return clock_.source(); }
  const PacketDecoder& decoder() const { return *decoder_; }

 private:
  LidarDriverResult Refuse(Refused refused);

  std::optional<uint32_t> sensor_address_;
  std::unique_ptr<const PacketDecoder> decoder_;
  SensorClock clock_;
  RevolutionAssembler revolutions_;
  DecodedPacket decoded_;
  std::optional<int64_t> last_utime_;
  RefusalCounts refused_{};
  int64_t used_ = 0;
};

}  // namespace hairpin
