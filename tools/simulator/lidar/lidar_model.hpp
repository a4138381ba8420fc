#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hairpin {

/// One laser of a rotating LiDAR.
struct Laser {
  double elevation;       // [rad]
  double azimuth_offset;  // added to the head's azimuth; clockwise seen from above [rad]
  int64_t firing_ns;      // after the beginning of the firing sequence
};

/// What is fixed by a sensor's design: all lasers fire once in a sequence, sequences follow without
/// a gap while the head turns clockwise.
struct LidarModel {
  std::string name;
  std::vector<Laser> lasers;  // in the order of their channels
  int64_t sequence_ns;
};

/// Velodyne VLP-32C. Source: its user manual (63-9325), tables of laser elevations, azimuth offsets
/// and firing times.
LidarModel Vlp32c();

}  // namespace hairpin
