#pragma once

#include <span>
#include <vector>

#include "daemons/lidar_cone_detector/cone_body.hpp"
#include "daemons/lidar_cone_detector/point_cloud.hpp"

namespace hairpin {

/// What a cone that nothing hides returns to one sensor or to several.
struct ExpectedReturns {
  float most = 0.0f;  // to the sensor that sees it best
  float all = 0.0f;   // to all of them together
  float top = 0.0f;   // height of the highest beam that meets the cone [m]; 0 where none does
};

/// The number of returns that a cone gives, beam by beam: every ring that meets it between
/// `min_height` and its top gives as many as firings fit into its width there. For a sensor with
/// even rings and a triangle for a cone that is E(d) = 1/2 h/(2 d tan(r_v/2)) w/(2 d tan(r_h/2)) of
/// the paper's citation; uneven rings and a tilted mount need the sum.
class ReturnModel {
 public:
  /// Sensors are those of the cloud; `min_height` above ground [m].
  void SetSensors(std::span<const SensorGeometry> sensors);
  ExpectedReturns Expect(float x, float y, float ground, const ConeBody& shape,
                         float min_height) const;

 private:
  struct Sensor {
    Eigen::Isometry3f T_sensor_base;
    std::vector<float> ring_tangent;
    float azimuth_step;
  };
  std::vector<Sensor> sensors_;
};

}  // namespace hairpin
