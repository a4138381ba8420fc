#pragma once

#include <string>

#include "tools/simulator/track.hpp"

namespace hairpin {

/// The track from above as an SVG picture, x to the right and y up: surface, cones in their colours
/// (drawn larger than they are), start and finish line, the waiting car as an arrow, clutter as
/// grey crosses, centre line length and a scale bar.
std::string DrawTrack(const Track& track);

}  // namespace hairpin
