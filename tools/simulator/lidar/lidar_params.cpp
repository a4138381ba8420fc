#include "tools/simulator/lidar/lidar_params.hpp"

#include <algorithm>
#include <numbers>

namespace hairpin {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr Range kShare{0.0, 1.0};

TerrainParams LoadTerrain(const Config& config) {
  TerrainParams params;
  params.max_slope = config.Number("max_slope", {0.0, 0.2});
  params.slope_length_m = config.Number("slope_length_m", {20.0, 1000.0});
  params.bump_height_m = config.Number("bump_height_m", {0.0, 0.2});
  params.bump_length_m = config.Number("bump_length_m", {4.0, 100.0});
  params.run_off_m = config.Number("run_off_m", {0.0, 50.0});
  params.margin_m = config.Number("margin_m", {1.0, 200.0});
  params.grass_height_m = config.Number("grass_height_m", {0.0, 0.5});
  return params;
}

ClutterParams LoadClutter(const Config& config) {
  ClutterParams params;
  params.min_distance_m = config.Number("min_distance_m", {0.5, 50.0});
  params.max_distance_m = config.Number("max_distance_m", {params.min_distance_m, 100.0});
  params.barrier_probability = config.Number("barrier_probability", kShare);
  params.person_probability = config.Number("person_probability", kShare);
  params.tyre_stack_probability = config.Number("tyre_stack_probability", kShare);
  params.sign_probability = config.Number("sign_probability", kShare);
  params.kerb_probability = config.Number("kerb_probability", kShare);
  return params;
}

Materials LoadMaterials(const Config& config) {
  constexpr std::array<const char*, kNumMaterials> kNames{
      "asphalt",        "grass",          "kerb",         "plastic_barrier", "metal",
      "rubber",         "cloth",          "sign_face",    "car_body",        "blue_plastic",
      "yellow_plastic", "orange_plastic", "white_stripe", "black_stripe"};
  Materials materials;
  for (size_t i = 0; i < kNames.size(); ++i) {
    const std::vector<double> values = config.Numbers(kNames[i], 2, {0.0, 1000.0});
    materials[i] = {values[0], std::min(values[1], 1.0)};
  }
  return materials;
}

BeamParams LoadBeam(const Config& config) {
  BeamParams params;
  params.horizontal_divergence_rad =
      1e-3 * config.Number("horizontal_divergence_mrad", {0.0, 20.0});
  params.vertical_divergence_rad = 1e-3 * config.Number("vertical_divergence_mrad", {0.0, 20.0});
  params.min_range_m = config.Number("min_range_m", {0.0, 5.0});
  params.max_range_m = config.Number("max_range_m", {10.0, 262.0});
  params.range_noise_m = config.Number("range_noise_m", {0.0, 0.5});
  params.laser_bias_m = config.Number("laser_bias_m", {0.0, 0.2});
  params.range_resolution_m = config.Number("range_resolution_m", {0.0, 5.0});
  params.reference_range_m = config.Number("reference_range_m", {1.0, 300.0});
  params.reference_reflectivity = config.Number("reference_reflectivity", {0.001, 1.0});
  params.loss = config.Number("loss", kShare);
  params.reflectivity_noise = config.Number("reflectivity_noise", kShare);
  return params;
}

}  // namespace

WorldParams LoadWorldParams(const Config& config) {
  const Config world = config.Section("lidar_world");
  WorldParams params;
  params.terrain = LoadTerrain(world.Section("terrain"));
  params.clutter = LoadClutter(world.Section("clutter"));
  params.materials = LoadMaterials(world.Section("materials"));
  params.cone_reflectivity_spread = world.Number("cone_reflectivity_spread", {0.0, 0.5});
  return params;
}

LidarRigParams LoadLidarRigParams(const Config& config) {
  LidarRigParams params;
  params.world = LoadWorldParams(config);
  const Config lidars = config.Section("lidars");
  params.sensor.model = Vlp32c();
  params.sensor.beam = LoadBeam(lidars.Section("beam"));
  params.sensor.rotation_hz = lidars.Number("rotation_hz", {5.0, 20.0});
  params.front_start_azimuth_rad = kDegree * lidars.Number("front_start_azimuth_deg", {0.0, 360.0});
  params.top_start_azimuth_rad = kDegree * lidars.Number("top_start_azimuth_deg", {0.0, 360.0});
  params.position_packet_hz = lidars.Number("position_packet_hz", {0.1, 100.0});
  const Config ride = lidars.Section("ride");
  params.ride.pitch_per_acceleration = ride.Number("pitch_rad_per_mps2", {0.0, 0.1});
  params.ride.roll_per_acceleration = ride.Number("roll_rad_per_mps2", {0.0, 0.1});
  return params;
}

}  // namespace hairpin
