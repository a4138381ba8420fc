#include "daemons/lidar_cone_detector/lidar_cone_detector_config.hpp"

namespace hairpin {
namespace {

constexpr Range kMetre{0.001, 1.0};

GroundParams LoadGround(const Config& config) {
  GroundParams params;
  params.grid.sectors = config.Integer("sectors", 8, 2048);
  params.grid.bin_length = config.Number("bin_length_m", {0.05, 2.0});
  params.grid.max_range = config.Number("max_range_m", {5.0, 100.0});
  params.plane.max_range = config.Number("plane_range_m", {2.0, 100.0});
  params.plane.tolerance = config.Number("plane_tolerance_m", kMetre);
  params.plane.max_tilt = config.Number("max_tilt_rad", {0.0, 0.3});
  params.lines.max_slope = config.Number("max_slope", {0.01, 1.0});
  params.lines.slope_sigma = config.Number("usual_slope", {0.001, 1.0});
  params.lines.height_sigma = config.Number("usual_roughness_m", kMetre);
  params.lines.tolerance = config.Number("line_tolerance_m", kMetre);
  params.lines.max_start_height = config.Number("max_start_height_m", kMetre);
  params.lines.min_points = config.Integer("min_line_points", 2, 20);
  return params;
}

ConeBody LoadShape(const Config& config) {
  ConeBody shape;
  shape.height = config.Number("height_m", {0.1, 2.0});
  shape.foot_radius = config.Number("foot_radius_m", {0.01, 0.5});
  shape.top_radius = config.Number("top_radius_m", {0.0, 0.5});
  return shape;
}

AcceptanceParams LoadAcceptance(const Config& config) {
  AcceptanceParams params;
  params.min_returns = config.Integer("min_returns", 1, 100);
  params.min_share = config.Number("min_share", {0.0, 1.0});
  params.max_share = config.Number("max_share", {1.0, 100.0});
  params.spare_returns = config.Number("spare_returns", {0.0, 100.0});
  params.missing_top = config.Number("missing_top_m", kMetre);
  params.excess_top = config.Number("excess_top_m", kMetre);
  params.max_residual = config.Number("max_residual_m", kMetre);
  return params;
}

}  // namespace

LidarConeDetectorParams LoadDetectorParams(const Config& config) {
  LidarConeDetectorParams params;
  params.max_range = config.Number("max_range_m", {1.0, 60.0});
  const Config ground = config.Section("ground");
  params.ground = LoadGround(ground);
  params.ground_band = ground.Number("band_m", kMetre);
  const Config clusters = config.Section("clusters");
  params.cluster_tolerance = clusters.Number("tolerance_m", {0.1, 1.0});
  params.max_height = clusters.Number("max_height_m", {0.1, 10.0});
  params.max_cluster_extent = clusters.Number("max_extent_m", {0.1, 2.0});
  const Config foot = config.Section("foot");
  params.foot_radius = foot.Number("radius_m", {0.05, 1.0});
  params.foot_height = foot.Number("min_height_m", {-0.1, params.ground_band});
  params.small_cone = LoadShape(config.Section("small_cone"));
  params.large_cone = LoadShape(config.Section("large_cone"));
  const Config fit = config.Section("fit");
  params.fit.range_sigma = fit.Number("range_sigma_m", kMetre);
  params.fit.prior_sigma = fit.Number("prior_sigma_m", kMetre);
  const Config acceptance = config.Section("acceptance");
  params.acceptance = LoadAcceptance(acceptance);
  params.surroundings.body_radius = params.foot_radius;
  params.surroundings.clearance = acceptance.Number("clearance_m", {0.1, 2.0});
  params.surroundings.same_height = acceptance.Number("same_height_m", kMetre);
  params.surroundings.min_returns = acceptance.Integer("min_neighbour_returns", 1, 100);
  params.min_distance = acceptance.Number("min_distance_m", kMetre);
  // CONE_CLUSTERS stays a message of moderate size, and local_mapper refuses sets of more than 200.
  params.max_cones = acceptance.Integer("max_cones", 1, 200);
  const Config covariance = config.Section("covariance");
  params.covariance.floor_sigma = covariance.Number("floor_sigma_m", kMetre);
  params.covariance.bearing_sigma = covariance.Number("bearing_sigma_rad", {0.0, 0.1});
  return params;
}

}  // namespace hairpin
