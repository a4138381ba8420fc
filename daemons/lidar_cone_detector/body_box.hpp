#pragma once

#include "common/car.hpp"

namespace hairpin {

/// The ground that the car's own body covers, in base: returns from there are its nose, wings and
/// wheels.
struct BodyBox {
  float min_x = 0.0f;
  float max_x = 0.0f;
  float half_width = 0.0f;

  bool Contains(float x, float y) const {
    return x > min_x && x < max_x && y > -half_width && y < half_width;
  }
};

/// The car's outline with a margin [m].
BodyBox BodyOf(const Car& car, double margin);

}  // namespace hairpin
