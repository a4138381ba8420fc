#pragma once

#include <Eigen/Core>
#include <span>

#include "daemons/lidar_cone_detector/cone_body.hpp"

namespace hairpin {

/// A return on a cone: position in base, height above the ground [m].
struct ConeReturn {
  Eigen::Vector2f position;
  float height;
};

struct ConeFitParams {
  double range_sigma = 0.0;  // noise of one return along its beam [m]
  double prior_sigma = 0.0;  // of the first guess [m]
};

struct ConeFit {
  Eigen::Vector2f axis = Eigen::Vector2f::Zero();  // base [m]
  float residual = 0.0f;                           // root mean square of |p - axis| - radius(h) [m]
};

/// The axis of the cone whose surface the returns lie on. A sensor sees only the near side, so the
/// mean of the returns lies in front of the axis, by pi/4 of the radius for an evenly sampled
/// circle: the first guess adds that along the line of sight from `sensor`; Gauss-Newton on
/// |p_i - axis| - radius(h_i), with the guess as prior, then uses where the surface bends. Needs at
/// least one return.
ConeFit FitCone(std::span<const ConeReturn> returns, const Eigen::Vector2f& sensor,
                const ConeBody& shape, const ConeFitParams& params);

}  // namespace hairpin
