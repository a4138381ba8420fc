#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace hairpin {

/// What a Velodyne position packet (512 bytes: time stamp at 198, PPS state at 202, an NMEA GPRMC
/// sentence from 206 on) says about time. Source: user manual 63-9325, "Position packet".
struct PositionPacket {
  uint32_t time_us = 0;              // past the hour on the sensor's clock
  bool pps_locked = false;           // that clock follows the receiver's pulse per second
  std::optional<int64_t> gps_utime;  // of the sentence, if it is whole and its receiver has a fix
};

inline constexpr size_t kPositionPacketSize = 512;

/// Empty for a packet of another size, or with a time stamp beyond the hour.
std::optional<PositionPacket> DecodePositionPacket(std::span<const uint8_t> packet);

/// Date and time of a GPRMC (or GNRMC) sentence in microseconds since the Unix epoch. Empty where
/// the checksum is wrong, the receiver warns (status V), or a field is missing or out of range.
/// Years 80 to 99 are of the 20th century.
std::optional<int64_t> ParseRmcTime(std::string_view sentence);

}  // namespace hairpin
