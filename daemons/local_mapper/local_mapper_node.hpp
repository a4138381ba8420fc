#pragma once

#include <cstdint>

#include "common/bus.hpp"
#include "common/config.hpp"
#include "daemons/local_mapper/local_mapper.hpp"

namespace hairpin {

/// VELOCITY, PIPELINE_STATUS and CONES_* in; one LOCAL_MAP for each set of observations used, with
/// its utime.
class LocalMapperNode {
 public:
  LocalMapperNode(const LocalMapperParams& params, Bus& bus);

 private:
  void SubscribeCones(const Channel<cones_t>& channel, Pipeline pipeline);
  void OnStatus(const pipeline_status_t& status);
  void OnVelocity(const velocity_t& velocity);

  Bus& bus_;
  LocalMapper mapper_;
  int64_t status_utime_ = 0;
};

/// Reads all of local_mapper.yaml. Throws ConfigError.
LocalMapperParams LoadLocalMapperParams(const Config& config);

}  // namespace hairpin
