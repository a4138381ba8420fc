#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace hairpin {

/// A detected cone's returns, in base at the cloud's time: what its colour is told from.
struct ConeReturns {
  Eigen::Vector2f axis = Eigen::Vector2f::Zero();  // [m]
  std::vector<float> x, y;                         // [m]
  std::vector<float> z;                            // above the ground [m]
  std::vector<float> age;                          // measured this long before the cloud's time [s]
  std::vector<uint8_t> intensity;
};

}  // namespace hairpin
