#pragma once

#include "daemons/lidar_cone_detector/polar_grid.hpp"

namespace hairpin {

struct GroundPlaneParams {
  double max_range = 0.0;  // cells beyond take no part [m]
  double max_tilt = 0.0;   // of the car's body against the ground [rad]
  double tolerance = 0.0;  // a cell this far off the plane has no say any more [m]
};

/// z = height + slope_x x + slope_y y in base: the ground as far as it is flat.
struct GroundPlane {
  float height = 0.0f;
  float slope_x = 0.0f;
  float slope_y = 0.0f;
  float At(float x, float y) const { return height + slope_x * x + slope_y * y; }
};

/// The plane through the lowest points of most cells: least squares, reweighted by Tukey's
/// biweight [Beaton and Tukey 1974] from the flat ground of a level car on, with a tolerance that
/// shrinks from what the tilt may lift. Bounded by the largest tilt; flat where cells are too few.
GroundPlane FitGroundPlane(const PolarGrid& grid, const GroundPlaneParams& params);

}  // namespace hairpin
