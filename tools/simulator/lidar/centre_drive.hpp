#pragma once

#include "tools/simulator/track_geometry.hpp"
#include "tools/simulator/vehicle.hpp"

namespace hairpin {

/// A car that follows a track's centre line, with its corners rounded, at constant speed along the
/// line and without slip, round and round where it is closed: motion for recording sensors without
/// anyone driving.
class CentreDrive {
 public:
  /// `speed` [m/s].
  CentreDrive(const Track& track, double speed);
  /// `time` [s] after the start at the start line.
  VehicleState At(double time) const;

 private:
  Eigen::Vector2d OnLine(double station) const;
  Eigen::Vector2d PositionAt(double station) const;
  Eigen::Vector2d TangentAt(double station) const;

  Polyline line_;
  bool closed_;
  double length_;
  double speed_;
};

}  // namespace hairpin
