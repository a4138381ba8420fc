#pragma once

#include <optional>

#include "common/bus.hpp"
#include "common/config.hpp"
#include "daemons/global_mapper/global_mapper.hpp"
#include "daemons/global_mapper/map_store.hpp"

namespace hairpin {

struct GlobalMapperConfig {
  GlobalMapperParams params;
  MapStoreParams store;
};

/// VELOCITY and LOCAL_MAP in; one GLOBAL_MAP for each LOCAL_MAP used, with its utime.
class GlobalMapperNode {
 public:
  GlobalMapperNode(const GlobalMapperConfig& config, Bus& bus);

 private:
  void OnVelocity(const velocity_t& velocity);
  void OnLocalMap(const local_map_t& message);

  Bus& bus_;
  GlobalMapper mapper_;
  MapStore store_;
  bool resumed_ = false;
};

/// Reads all of global_mapper.yaml. Throws ConfigError.
GlobalMapperConfig LoadGlobalMapperConfig(const Config& config);

}  // namespace hairpin
