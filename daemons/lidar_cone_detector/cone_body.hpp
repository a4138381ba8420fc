#pragma once

#include <algorithm>

namespace hairpin {

/// A traffic cone: a truncated cone on a square plate [m].
struct ConeBody {
  double height = 0.0;
  double foot_radius = 0.0;  // of the body where it stands on its plate
  double top_radius = 0.0;

  /// Radius of the body at a height above the ground; the foot's below, the top's above.
  float RadiusAt(float above_ground) const {
    const float share = std::clamp(above_ground / static_cast<float>(height), 0.0f, 1.0f);
    return static_cast<float>(foot_radius) + share * static_cast<float>(top_radius - foot_radius);
  }
};

}  // namespace hairpin
