#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <variant>

#include "daemons/gnss_driver/gnss_fix.hpp"

namespace hairpin {

/// A sentence or frame whose checksum is right and whose content is not: what is wrong with it.
class GnssFormatError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Time of day of an epoch, UTC [us].
using TimeOfDay = int64_t;

/// Position and type of fix. The position is empty where there is none.
struct NmeaGga {
  TimeOfDay time = 0;
  FixType type = FixType::kUnknown;
  std::optional<GeodeticPoint> position;
  double dilution = 0.0;  // of horizontal precision
};

/// Date, and course and speed over ground where known.
struct NmeaRmc {
  TimeOfDay time = 0;
  int64_t day_utime = 0;                    // midnight, us since the Unix epoch
  std::optional<Eigen::Vector2d> velocity;  // east, north [m/s]
};

struct NmeaVtg {
  std::optional<Eigen::Vector2d> velocity;  // east, north [m/s]
};

/// Heading of the line of antennas, counter-clockwise from east [rad].
struct NmeaHdt {
  std::optional<double> heading;
};

/// Standard deviations of east, north, up [m].
struct NmeaGst {
  TimeOfDay time = 0;
  std::optional<Eigen::Vector3d> sigma;
};

using NmeaMessage = std::variant<NmeaGga, NmeaRmc, NmeaVtg, NmeaHdt, NmeaGst>;

/// Reads a sentence, "GPGGA,..." without '$' and checksum, of any talker. Empty for sentences of
/// other kinds and for those without a time. Throws GnssFormatError. Source: NMEA 0183 version 4.1.
std::optional<NmeaMessage> ParseNmea(std::string_view text);

}  // namespace hairpin
