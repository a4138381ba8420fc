#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hairpin {

/// Returns of all sensors together, deskewed: base at one time. Structure of arrays, so that each
/// stage reads only what it needs and the compiler can take several points at once.
struct PointCloud {
  std::vector<float> x;  // base [m]
  std::vector<float> y;
  std::vector<float> z;
  std::vector<float> age;  // fired this long before the cloud's time [s]
  std::vector<uint8_t> intensity;
  std::vector<uint8_t> ring;
  std::vector<uint8_t> sensor;  // index into the list of sensors that goes with the cloud

  size_t size() const { return x.size(); }
  void Clear();
  void Resize(size_t count);
  void Add(const Eigen::Vector3f& position, float point_age, uint8_t point_intensity,
           uint8_t point_ring, uint8_t point_sensor);
  /// In place of point `i`.
  void Set(size_t i, const Eigen::Vector3f& position, float point_age, uint8_t point_intensity,
           uint8_t point_ring, uint8_t point_sensor) {
    x[i] = position.x();
    y[i] = position.y();
    z[i] = position.z();
    age[i] = point_age;
    intensity[i] = point_intensity;
    ring[i] = point_ring;
    sensor[i] = point_sensor;
  }
};

/// Where a sensor sits and how densely it looks: what the expected number of returns depends on.
struct SensorGeometry {
  Eigen::Isometry3f T_base_sensor = Eigen::Isometry3f::Identity();
  std::vector<float> ring_elevation;  // by ring number, rising [rad]
  float azimuth_step = 0.0f;          // between firings of a ring [rad]
};

}  // namespace hairpin
