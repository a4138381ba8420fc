#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "tools/simulator/lidar/scene.hpp"

namespace hairpin {

class HashRandom;

/// Optics and receiver of a LiDAR.
struct BeamParams {
  double horizontal_divergence_rad = 0.0;  // full angle
  double vertical_divergence_rad = 0.0;
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  double range_noise_m = 0.0;       // one sigma of a return
  double laser_bias_m = 0.0;        // sigma of what each laser is off, drawn once
  double range_resolution_m = 0.0;  // echoes nearer to each other than this melt into one
  double reference_range_m =
      0.0;  // where a target of `reference_reflectivity` is seen every other time
  double reference_reflectivity = 0.0;
  double loss = 0.0;                // probability that a good echo is missed anyway
  double reflectivity_noise = 0.0;  // sigma, as a share of the value
};

/// What the sensor reports of one firing of one laser.
struct LidarReturn {
  float range = 0.0f;         // [m]; 0: none
  float reflectivity = 0.0f;  // 1: white diffuse target that fills the beam; above: retro-reflector
  int cone = -1;              // which cone, by the scene's index; -1: none
};

/// Directions of a beam's rays about `direction` (a unit vector), whose share of the beam's light
/// is RayShare(). `across` and `up` are unit vectors orthogonal to it.
BeamDirections SpreadBeam(const BeamParams& params, const Eigen::Vector3f& direction,
                          const Eigen::Vector3f& across, const Eigen::Vector3f& up);
/// Share of the beam's light in ray `ray`; they sum to 1.
float RayShare(size_t ray);

/// The strongest echo of a beam. Rays whose targets lie within the range resolution add up to one
/// echo, at the range of their mean weighted by energy (that is how a beam over an edge gives a
/// point between); energy falls with the range squared; what is too weak is lost.
LidarReturn StrongestReturn(const BeamParams& params, const BeamTargets& targets, double laser_bias,
                            HashRandom& random);

/// The reflectivity byte of calibrated sensors: 0 to 100 for diffuse targets, in percent, and 101
/// to 255 for retro-reflectors, by the logarithm of their gain up to 100.
uint8_t ReflectivityByte(float reflectivity);

}  // namespace hairpin
