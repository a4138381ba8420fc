#pragma once

#include "common/config.hpp"
#include "tools/simulator/lidar/lidar_rig.hpp"

namespace hairpin {

/// Reads the section `lidar_world` of simulator.yaml.
WorldParams LoadWorldParams(const Config& config);
/// Reads the sections `lidar_world` and `lidars` of simulator.yaml.
LidarRigParams LoadLidarRigParams(const Config& config);

}  // namespace hairpin
