#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tools/simulator/random.hpp"
#include "tools/simulator/track_geometry.hpp"

namespace hairpin {

/// A polygon for a track to follow, and which of its edges is to hold the start. Counter-clockwise.
struct TrackOutline {
  Polyline corners;
  size_t start_edge = 0;  // from corners[start_edge] to the next
};

struct OutlineParams {
  size_t edges = 20;          // of the grid along the boundary, at least
  double min_spacing = 11.0;  // m between neighbouring lines of the grid, each drawn at random
  double max_spacing = 20.0;
  double shift = 2.0;  // m by which a corner leaves the grid in x and y at most
  double merge = 0.6;  // probability that a corner in mid-straight is left out
  double shortcut =
      0.5;  // probability that the second of two opposite bends is left out: a diagonal instead
};

/// The boundary of a random clump of cells of an uneven grid, without holes. Its longest straight
/// is the start edge.
TrackOutline RandomOutline(const OutlineParams& params, RandomStream& random);

}  // namespace hairpin
