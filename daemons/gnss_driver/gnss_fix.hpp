#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "common/local_enu.hpp"

namespace hairpin {

/// Numbered as in gnss_t.
enum class FixType {
  kUnknown = 0,
  kNone = 1,
  kSingle = 2,
  kDifferential = 3,
  kFloat = 4,
  kRtk = 5
};

/// What the receiver measured at one time. East, north, up; standard deviations.
struct GnssFix {
  int64_t utime = 0;  // UTC of the measurement, us since the Unix epoch
  FixType type = FixType::kUnknown;
  GeodeticPoint position;                                    // of the antenna
  Eigen::Vector3d position_sigma = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();        // m/s
  Eigen::Vector3d velocity_sigma = Eigen::Vector3d::Zero();  // m/s
  bool has_velocity = false;
  std::optional<double> heading;  // of the line of antennas, counter-clockwise from east [rad]
  double heading_sigma = 0.0;     // rad
};

/// What stands in where the receiver does not say how good it is.
struct GnssErrorModel {
  double single_m = 0.0;  // horizontal position at a dilution of precision of 1, by type of fix
  double differential_m = 0.0;
  double float_m = 0.0;
  double rtk_m = 0.0;
  double vertical_factor = 0.0;  // vertical against horizontal
  double velocity_mps = 0.0;     // NMEA tells none
  double heading_rad = 0.0;      // NMEA tells none
};

}  // namespace hairpin
