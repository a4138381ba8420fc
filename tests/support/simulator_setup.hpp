#pragma once

#include <string>

#include "common/car.hpp"
#include "tools/simulator/simulator_params.hpp"

namespace hairpin {

/// What `config/` holds: the simulator as it is shipped.
inline SimulatorParams ShippedSimulatorParams() {
  return LoadSimulatorParams(
      Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "simulator"));
}

inline Car ShippedCar() {
  return LoadCar(Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "simulator"));
}

}  // namespace hairpin
