#pragma once

#include <cstdint>
#include <optional>

#include "tools/simulator/track.hpp"

namespace hairpin {

struct GeneratorOptions {
  uint64_t seed = 1;
  std::optional<double> length;  // of the lap [m], 200 to 500; empty: 240 to 440, by the seed
  int clutter = 0;               // things beside the track, 0 to 200
};

/// A random closed track that obeys CheckRules(), the same for the same options on every machine:
/// positions are whole millimetres. The car waits at the origin, facing along x, 6 m before the
/// start line.
///
/// Method: a random outline is grown from cells of an uneven grid, one at a time so that it stays
/// in one piece without a hole (the Eden model of growth); its boundary, with corners shifted,
/// straights merged and zigzags cut short at random, is the polygon to follow; corners are rounded
/// with arcs, all is scaled to the length asked for, and cones are set along both sides, closer
/// together where these bend. What breaks a rule is thrown away and tried again, 500 times at most.
///
/// Throws std::invalid_argument for options out of range, std::runtime_error where no try was legal
/// or where there is no room for the clutter.
Track GenerateTrack(const GeneratorOptions& options);

/// The straight of the acceleration event [Formula Student Germany rules, and what its organisers
/// build]: 75 m between two gates of large orange cones, 3.5 m wide, cones every 5 m, and 100 m of
/// lane to stop in between small orange cones. The car waits at the origin, its nose 0.3 m before
/// the start line.
Track AccelerationTrack();

}  // namespace hairpin
