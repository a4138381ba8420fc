#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tools/simulator/lidar/lidar_sensor.hpp"

namespace hairpin {

using VelodyneDataPacket = std::array<uint8_t, 1206>;
using VelodynePositionPacket = std::array<uint8_t, 512>;

/// The UDP payloads of a Velodyne VLP-32C in strongest return mode. Source: user manual 63-9325,
/// "Data packet" and "Position packet".
///
/// Data: 12 blocks of flag 0xFFEE, azimuth (0.01 deg, clockwise) and 32 returns (range in 4 mm, 0
/// none; reflectivity), then microseconds past the hour of the first firing, return mode and model.
class VelodyneEncoder {
 public:
  /// `epoch_us`: the time, since the Unix epoch, that the sequences' times count from.
  explicit VelodyneEncoder(int64_t epoch_us) : epoch_us_(epoch_us) {}

  /// Adds a sequence of 32 returns; gives back the packet that it completes, each twelfth time.
  /// Throws std::invalid_argument for another number of returns.
  std::optional<VelodyneDataPacket> Add(const FiringSequence& sequence);

 private:
  int64_t epoch_us_;
  size_t blocks_ = 0;
  VelodyneDataPacket packet_{};
};

/// The position packet of a sensor with a good GPS receiver: microseconds past the hour, PPS
/// locked, and a GPRMC sentence of that second. `utime_us`: since the Unix epoch.
VelodynePositionPacket EncodeVelodynePosition(int64_t utime_us);

}  // namespace hairpin
