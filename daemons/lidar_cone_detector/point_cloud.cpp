#include "daemons/lidar_cone_detector/point_cloud.hpp"

namespace hairpin {

void PointCloud::Clear() {
  x.clear();
  y.clear();
  z.clear();
  age.clear();
  intensity.clear();
  ring.clear();
  sensor.clear();
}

void PointCloud::Reserve(size_t capacity) {
  x.reserve(capacity);
  y.reserve(capacity);
  z.reserve(capacity);
  age.reserve(capacity);
  intensity.reserve(capacity);
  ring.reserve(capacity);
  sensor.reserve(capacity);
}

void PointCloud::Add(const Eigen::Vector3f& position, float point_age, uint8_t point_intensity,
                     uint8_t point_ring, uint8_t point_sensor) {
  x.push_back(position.x());
  y.push_back(position.y());
  z.push_back(position.z());
  age.push_back(point_age);
  intensity.push_back(point_intensity);
  ring.push_back(point_ring);
  sensor.push_back(point_sensor);
}

}  // namespace hairpin
