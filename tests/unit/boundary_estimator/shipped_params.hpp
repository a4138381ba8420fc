#pragma once

#include "daemons/boundary_estimator/boundary_estimator_node.hpp"

namespace hairpin::test {

/// What the car drives with.
inline BoundaryEstimatorParams ShippedParams() {
  return LoadBoundaryEstimatorParams(
      Config::Load(HAIRPIN_SOURCE_DIR "/config", "boundary_estimator"));
}

inline ColourDistribution Certain(ConeColour colour) {
  ColourDistribution distribution{};
  distribution[static_cast<size_t>(colour)] = 1.0;
  return distribution;
}

inline MapCone Cone(int64_t id, double x, double y, ConeColour colour) {
  return {id, {x, y}, Certain(colour), 1.0};
}

}  // namespace hairpin::test
