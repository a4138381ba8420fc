#pragma once

#include <cstdint>

#include "common/bus.hpp"
#include "common/config.hpp"
#include "daemons/boundary_estimator/boundary_estimator.hpp"

namespace hairpin {

/// Reads all of `boundary_estimator.yaml`. Throws ConfigError.
BoundaryEstimatorParams LoadBoundaryEstimatorParams(const Config& config);

/// Answers each LOCAL_MAP with a TRACK. Refused are maps whose time does not increase, and maps
/// with a cone that cannot be: covariance not positive definite, probabilities out of range, an id
/// that stands twice.
class BoundaryEstimatorNode {
 public:
  BoundaryEstimatorNode(const BoundaryEstimatorParams& params, Bus& bus);

 private:
  void OnLocalMap(const local_map_t& message);

  Bus& bus_;
  BoundaryEstimator estimator_;
  int64_t last_utime_ = 0;
};

}  // namespace hairpin
