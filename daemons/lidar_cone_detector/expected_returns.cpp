#include "daemons/lidar_cone_detector/expected_returns.hpp"

#include <algorithm>
#include <cmath>

namespace hairpin {

void ReturnModel::SetSensors(std::span<const SensorGeometry> sensors) {
  sensors_.resize(sensors.size());
  for (size_t s = 0; s < sensors.size(); ++s) {
    sensors_[s].T_sensor_base = sensors[s].T_base_sensor.inverse();
    sensors_[s].azimuth_step = sensors[s].azimuth_step;
    sensors_[s].ring_tangent.clear();
    for (const float elevation : sensors[s].ring_elevation)
      sensors_[s].ring_tangent.push_back(std::tan(elevation));
  }
}

ExpectedReturns ReturnModel::Expect(float x, float y, float ground, const ConeBody& shape,
                                    float min_height) const {
  ExpectedReturns expected;
  const auto height = static_cast<float>(shape.height);
  for (const Sensor& sensor : sensors_) {
    const Eigen::Vector3f foot = sensor.T_sensor_base * Eigen::Vector3f(x, y, ground);
    const Eigen::Vector3f top = sensor.T_sensor_base * Eigen::Vector3f(x, y, ground + height);
    const float range = std::max(foot.head<2>().norm(), 0.1f);
    const float rise = std::max(top.z() - foot.z(), 1e-3f);
    float returns = 0.0f;
    for (const float tangent : sensor.ring_tangent) {
      const float above = (range * tangent - foot.z()) / rise * height;
      if (above < min_height || above > height) continue;
      returns += 2.0f * shape.RadiusAt(above) / (range * sensor.azimuth_step);
      expected.top = std::max(expected.top, above);
    }
    expected.most = std::max(expected.most, returns);
    expected.all += returns;
  }
  return expected;
}

}  // namespace hairpin
