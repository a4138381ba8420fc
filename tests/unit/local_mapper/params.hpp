#pragma once

#include <cmath>
#include <vector>

#include "daemons/local_mapper/local_mapper.hpp"

namespace hairpin::test {

inline DetectorModel TestDetector() {
  return {{{1.0, 5.0, 11.0, 14.0, 16.0, 20.0}, {0.93, 0.93, 0.89, 0.74, 0.39, 0.0}}, 0.05};
}

inline LocalMapParams TestMapParams() {
  LocalMapParams params;
  params.association = {.gate_chi2 = 11.8, .gate_sigma = 0.08};
  params.min_cone_distance = 0.4;
  params.odometry = {.position_sigma = 0.015, .yaw_sigma = 0.001};
  params.unknown_colour_weight = 0.2;
  params.existence = {
      .at_first_sight = 0.55, .max = 0.99, .removed_below = 0.37, .max_credited_recall = 0.8};
  params.visibility = {.bearing_margin = 0.05, .range_margin = 0.5, .occlusion_half_width = 0.2};
  params.detector = {TestDetector(), TestDetector(), TestDetector()};
  params.forget_distance = 40.0;
  params.forget_radius = 50.0;
  params.max_cones = 500;
  return params;
}

inline LocalMapperParams TestMapperParams() {
  LocalMapperParams params;
  params.map = TestMapParams();
  params.trust.lidar_beside_camera = {.position_weight = 1.0, .colour_weight = 0.05};
  params.trust.camera_beside_lidar = {.position_weight = 0.05, .colour_weight = 1.0};
  params.history = 1.0;
  params.velocity_deadline = 0.1;
  params.max_velocity_gap = 0.5;
  params.gap_acceleration = 10.0;
  params.gap_yaw_acceleration = 5.0;
  params.max_speed = 60.0;
  params.max_yaw_rate = 10.0;
  params.cycle = 0.1;
  params.max_observations = 200;
  return params;
}

inline ColourDistribution Mostly(ConeColour colour) {
  ColourDistribution distribution{0.04, 0.04, 0.04, 0.04, 0.04};
  distribution[static_cast<size_t>(colour)] = 0.84;
  return distribution;
}

inline ConeObservation Seen(double x, double y, ConeColour colour = ConeColour::kBlue,
                            double sigma = 0.06) {
  return {{x, y}, sigma * sigma * Eigen::Matrix2d::Identity(), Mostly(colour)};
}

/// Everything within 100 degrees left and right and 22 m.
inline ObservationSet SetAt(int64_t utime, std::vector<ConeObservation> cones,
                            Pipeline pipeline = Pipeline::kFusion) {
  return {utime, pipeline, {{-1.75, 1.75, 22.0}}, std::move(cones)};
}

}  // namespace hairpin::test
