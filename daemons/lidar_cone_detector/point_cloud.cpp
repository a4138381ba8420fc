#include "daemons/lidar_cone_detector/point_cloud.hpp"

namespace hairpin {

void PointCloud::Clear() { Resize(0); }

void PointCloud::Resize(size_t count) {
  x.resize(count);
  y.resize(count);
  z.resize(count);
  age.resize(count);
  intensity.resize(count);
  ring.resize(count);
  sensor.resize(count);
}

void PointCloud::Add(const Eigen::Vector3f& position, float point_age, uint8_t point_intensity,
                     uint8_t point_ring, uint8_t point_sensor) {
  Resize(size() + 1);
  Set(size() - 1, position, point_age, point_intensity, point_ring, point_sensor);
}

}  // namespace hairpin
