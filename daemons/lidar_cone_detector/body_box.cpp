#include "daemons/lidar_cone_detector/body_box.hpp"

namespace hairpin {

BodyBox BodyOf(const Car& car, double margin) {
  return {static_cast<float>(-car.rear_overhang - margin),
          static_cast<float>(car.front_overhang + margin),
          static_cast<float>(0.5 * car.body_width + margin)};
}

}  // namespace hairpin
