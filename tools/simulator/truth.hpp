#pragma once

#include <cstdint>

#include "hairpin/truth_t.hpp"
#include "hairpin/truth_track_t.hpp"
#include "tools/simulator/track.hpp"
#include "tools/simulator/vehicle.hpp"

namespace hairpin {

/// The car's true motion. Lap and penalties are the referee's to add.
truth_t TruthMessage(const VehicleState& state, int64_t utime);

/// The whole track, clutter of the track's file included (colour unknown).
truth_track_t TruthTrackMessage(const Track& track, int64_t utime, uint64_t seed);

}  // namespace hairpin
