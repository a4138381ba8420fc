#pragma once

#include <cstdint>
#include <vector>

#include "common/car.hpp"
#include "daemons/lidar_cone_detector/cone_returns.hpp"
#include "tools/simulator/lidar/lidar_rig.hpp"

namespace hairpin {

/// A cone as one or two LiDARs saw it, and its true colour.
struct LabelledCone {
  ConeReturns returns;
  ConeColour colour = ConeColour::kUnknown;
};

/// One scan of a random world: cones of every colour strewn before the car among clutter, with
/// reflectivities, sensors (ring patterns, rates, noise), mounts and ground drawn about those of
/// `params` and `car`. Each cone's returns are those within a cone's reach of its axis and above
/// the ground, both known with an error such as a detector makes. The same seed, the same cones.
std::vector<LabelledCone> RenderClusters(const LidarRigParams& params, const Car& car,
                                         uint64_t seed);

}  // namespace hairpin
