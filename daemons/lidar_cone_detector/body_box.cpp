#include "daemons/lidar_cone_detector/body_box.hpp"

namespace hairpin {

void BodyBox::RemoveFrom(const PointCloud& cloud, PointCloud& out) const {
  out.Clear();
  out.Reserve(cloud.size());
  for (size_t i = 0; i < cloud.size(); ++i) {
    if (Contains(cloud.x[i], cloud.y[i])) continue;
    out.Add({cloud.x[i], cloud.y[i], cloud.z[i]}, cloud.age[i], cloud.intensity[i], cloud.ring[i],
            cloud.sensor[i]);
  }
}

BodyBox BodyOf(const Car& car, double margin) {
  return {static_cast<float>(-car.rear_overhang - margin),
          static_cast<float>(car.front_overhang + margin),
          static_cast<float>(0.5 * car.body_width + margin)};
}

}  // namespace hairpin
