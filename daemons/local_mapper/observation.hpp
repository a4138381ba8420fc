#pragma once

#include <cstdint>
#include <vector>

#include "common/cone.hpp"
#include "common/map_mode.hpp"

namespace hairpin {

/// A sector about base that a working sensor covered; bearings [rad] counter-clockwise from x
/// forward, min < max.
struct ViewSector {
  double min_bearing = 0.0;
  double max_bearing = 0.0;
  double max_range = 0.0;  // m
};

/// All that one pipeline saw at one time, in base at that time.
struct ObservationSet {
  int64_t utime = 0;
  Pipeline pipeline = Pipeline::kFusion;
  std::vector<ViewSector> sectors;
  std::vector<ConeObservation> cones;
};

}  // namespace hairpin
