#pragma once

#include <Eigen/Geometry>

#include "common/car.hpp"
#include "tools/simulator/lidar/terrain.hpp"
#include "tools/simulator/vehicle.hpp"

namespace hairpin {

struct RideParams {
  double pitch_per_acceleration = 0.0;  // nose up when it accelerates [rad / (m/s^2)]
  double roll_per_acceleration = 0.0;   // outward [rad / (m/s^2)]
};

/// T_map_base in space of a car that stands on `terrain` with its four wheels (the plane that fits
/// their heights) and leans on its springs.
Eigen::Isometry3d RidePose(const RideParams& params, const Car& car, const Terrain& terrain,
                           const VehicleState& state);

}  // namespace hairpin
