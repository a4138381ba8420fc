#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/local_enu.hpp"
#include "hairpin/gnss_t.hpp"

namespace hairpin {

enum class GnssProtocol { kUbx, kNmea };

struct GnssReceiverParams {
  GnssProtocol protocol = GnssProtocol::kUbx;
  GeodeticPoint origin;  // where the map's frame lies on Earth: x east, y north
};

/// The simulated receiver's serial port: each epoch as a dual-antenna receiver tells it. UBX:
/// NAV-PVT and NAV-RELPOSNED [u-blox UBX-22008968, 3.15]; NMEA 0183: GGA, RMC, GST, VTG and HDT
/// with the digits of a surveyor's receiver. The antennas' baseline is base's x axis.
class GnssReceiver {
 public:
  /// Throws std::invalid_argument for an origin that is no place on Earth.
  explicit GnssReceiver(const GnssReceiverParams& params);

  std::vector<uint8_t> Epoch(const gnss_t& measured) const;

 private:
  std::vector<uint8_t> Ubx(const gnss_t& measured, const GeodeticPoint& position) const;
  std::vector<uint8_t> Nmea(const gnss_t& measured, const GeodeticPoint& position) const;

  GnssProtocol protocol_;
  LocalEnu plane_;
};

}  // namespace hairpin
