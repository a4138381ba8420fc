#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tools/simulator/lidar/material.hpp"
#include "tools/simulator/lidar/mesh.hpp"
#include "tools/simulator/track.hpp"

namespace hairpin {

/// How much of what a real event has beside its track.
struct ClutterParams {
  double min_distance_m = 0.0;  // from any cone, except for kerbs
  double max_distance_m = 0.0;
  // Probability that one of these stands beside a cone of the boundary.
  double barrier_probability = 0.0;
  double person_probability = 0.0;
  double tyre_stack_probability = 0.0;
  double sign_probability = 0.0;
  double kerb_probability = 0.0;
};

/// One thing of one material.
struct Thing {
  TriangleMesh mesh;
  Material material;
};

/// Ground height in map at x, y [m].
using HeightFunction = std::function<double(double x, double y)>;

/// Barriers, people (some in a reflecting vest), stacked tyres, signs and kerbs along the outside
/// of the track, drawn from `seed`, and a box for each of the track's own clutter. In map.
std::vector<Thing> PlaceClutter(const ClutterParams& params, const Track& track,
                                const HeightFunction& height, uint64_t seed);

}  // namespace hairpin
