#include "common/channels.hpp"
#include "daemons/local_mapper/local_mapper_node.hpp"

namespace hairpin {
namespace {

constexpr Range kProbability{1e-6, 1.0 - 1e-6};
constexpr Range kUnit{0.0, 1.0};

DetectorModel LoadDetector(const Config& config) {
  DetectorModel model;
  model.recall.range = config.Numbers("recall_range_m", 0, {0.0, 200.0});
  model.recall.recall = config.Numbers("recall", model.recall.range.size(), kUnit);
  model.false_positive = config.Number("false_positive_probability", kProbability);
  return model;
}

Trust LoadTrust(const Config& config) {
  return {config.Number("position_weight", {1e-6, 1e3}), config.Number("colour_weight", {0.0, 1e3}),
          config.Flag("refines_pose")};
}

ExistenceParams LoadExistence(const Config& config) {
  return {config.Number("at_first_sight_probability", kProbability),
          config.Number("max_probability", kProbability),
          config.Number("removed_below_probability", kProbability),
          config.Number("max_credited_recall", kProbability)};
}

PoseRefinementParams LoadRefinement(const Config& config) {
  return {config.Number("velocity_sigma_mps", {1e-3, 10.0}),
          config.Number("yaw_rate_sigma_radps", {1e-3, 10.0}),
          config.Number("stamp_sigma_s", {0.0, 1.0}),
          static_cast<size_t>(config.Integer("min_pairs", 2, 100))};
}

LocalMapParams LoadMap(const Config& config) {
  LocalMapParams params;
  params.association.gate_chi2 = config.Number("gate_chi2", {0.1, 100.0});
  params.association.gate_sigma = config.Number("gate_sigma_m", {0.0, 1.0});
  params.refinement = LoadRefinement(config.Section("refinement"));
  params.min_cone_distance = config.Number("min_cone_distance_m", {0.0, 5.0});
  params.odometry.position_sigma = config.Number("odometry_position_sigma_m_per_sqrt_m", kUnit);
  params.odometry.yaw_sigma = config.Number("odometry_yaw_sigma_rad_per_sqrt_m", kUnit);
  params.unknown_colour_weight = config.Number("unknown_colour_weight", {1e-3, 1.0});
  params.existence = LoadExistence(config.Section("existence"));
  params.visibility.bearing_margin = config.Number("view_bearing_margin_rad", kUnit);
  params.visibility.range_margin = config.Number("view_range_margin_m", {0.0, 10.0});
  params.visibility.occlusion_half_width = config.Number("occlusion_half_width_m", {0.01, 2.0});
  const Config detectors = config.Section("detectors");
  params.detector = {LoadDetector(detectors.Section("fusion")),
                     LoadDetector(detectors.Section("lidar")),
                     LoadDetector(detectors.Section("camera"))};
  params.forget_distance = config.Number("forget_distance_m", {1.0, 1000.0});
  params.forget_radius = config.Number("forget_radius_m", {1.0, 1000.0});
  // LOCAL_MAP stays under 60 kB.
  params.max_cones = static_cast<size_t>(config.Integer("max_cones", 1, 650));
  return params;
}

}  // namespace

LocalMapperParams LoadLocalMapperParams(const Config& config) {
  LocalMapperParams params;
  params.map = LoadMap(config);
  const Config trust = config.Section("trust");
  params.trust = {LoadTrust(trust.Section("fusion")), LoadTrust(trust.Section("lidar_only")),
                  LoadTrust(trust.Section("camera_only")),
                  LoadTrust(trust.Section("lidar_beside_camera")),
                  LoadTrust(trust.Section("camera_beside_lidar"))};
  params.history = config.Number("history_s", {0.5, 10.0});
  params.max_velocity_gap =
      config.Number("max_velocity_gap_s", {channels::kVelocity.deadline_s, 10.0});
  params.gap_acceleration = config.Number("gap_acceleration_mps2", {0.0, 100.0});
  params.gap_yaw_acceleration = config.Number("gap_yaw_acceleration_radps2", {0.0, 100.0});
  params.max_speed = config.Number("max_speed_mps", {1.0, 200.0});
  params.max_yaw_rate = config.Number("max_yaw_rate_radps", {0.1, 100.0});
  params.max_observations = static_cast<size_t>(config.Integer("max_observations", 1, 1000));
  params.velocity_deadline = channels::kVelocity.deadline_s;
  params.cycle = 1.0 / channels::kConesFusion.rate_hz;
  config.Finish();
  return params;
}

}  // namespace hairpin
