#pragma once

#include <cstdint>
#include <optional>

#include "daemons/gnss_driver/byte_reader.hpp"
#include "daemons/gnss_driver/gnss_fix.hpp"
#include "daemons/gnss_driver/nmea.hpp"

namespace hairpin {

inline constexpr uint16_t kUbxNavPvt = 0x0107;
inline constexpr uint16_t kUbxNavRelPosNed = 0x013c;
inline constexpr size_t kUbxNavPvtSize = 92;
inline constexpr size_t kUbxNavRelPosNedSize = 64;

/// NAV-PVT: everything of an epoch but the heading. `time_of_week_ms` names the epoch.
struct UbxNavPvt {
  uint32_t time_of_week_ms = 0;
  GnssFix fix;
};

/// NAV-RELPOSNED: the line from the one antenna to the other. Empty heading where the receiver does
/// not vouch for it.
struct UbxNavRelPosNed {
  uint32_t time_of_week_ms = 0;
  std::optional<double> heading;  // counter-clockwise from east [rad]
  double heading_sigma = 0.0;     // rad
};

/// Read payloads. ParseNavPvt is empty while the receiver does not yet know the time. Throw
/// GnssFormatError for sizes and values that cannot be. Source: u-blox F9 HPG interface
/// description, UBX-22008968, 3.15.
std::optional<UbxNavPvt> ParseNavPvt(Bytes payload);
UbxNavRelPosNed ParseNavRelPosNed(Bytes payload);

}  // namespace hairpin
