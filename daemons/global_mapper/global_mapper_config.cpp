#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "daemons/global_mapper/conversion.hpp"
#include "daemons/global_mapper/global_mapper_node.hpp"
#include "daemons/global_mapper/race_line_sender.hpp"

namespace hairpin {
namespace {

constexpr Range kPositive{1e-6, 1e6};
constexpr Range kUnit{0.0, 1.0};

ConstellationParams LoadConstellation(const Config& config) {
  ConstellationParams params;
  params.tolerance = config.Number("tolerance_m", {0.05, 2.0});
  params.max_translation = config.Number("max_translation_m", {0.1, 100.0});
  params.max_rotation = config.Number("max_rotation_rad", {0.01, 3.2});
  params.min_pairs = static_cast<size_t>(config.Integer("min_pairs", 3, 40));
  params.min_lead = static_cast<size_t>(config.Integer("min_lead", 1, 40));
  params.contradiction_weight = config.Number("contradiction_weight", {0.0, 1.0});
  return params;
}

ConeFilter LoadFilter(const Config& config) {
  return {config.Number("max_range_m", {1.0, 50.0}), config.Number("min_existence", kUnit),
          config.Integer("min_observations", 1, 1000)};
}

OdometryParams LoadOdometry(const Config& config) {
  OdometryParams params;
  params.history = config.Number("history_s", {1.0, 60.0});
  params.error_time = config.Number("velocity_error_time_s", {1e-3, 10.0});
  params.position_sigma = config.Number("position_sigma_m_per_sqrt_m", kUnit);
  params.yaw_sigma = config.Number("yaw_sigma_rad_per_sqrt_m", kUnit);
  params.min_position_sigma = config.Number("min_position_sigma_m", {1e-5, 1.0});
  params.min_yaw_sigma = config.Number("min_yaw_sigma_rad", {1e-6, 1.0});
  params.gap_acceleration = config.Number("gap_acceleration_mps2", {0.0, 100.0});
  params.gap_yaw_acceleration = config.Number("gap_yaw_acceleration_radps2", {0.0, 100.0});
  return params;
}

GraphParams LoadGraph(const Config& config) {
  GraphParams params;
  params.window_poses = static_cast<size_t>(config.Integer("window_keyframes", 2, 200));
  params.window.max_iterations = config.Integer("window_max_iterations", 1, 100);
  params.full.max_iterations = config.Integer("full_max_iterations", 1, 100);
  params.window.loss_scale = params.full.loss_scale = config.Number("loss_scale", {0.0, 100.0});
  params.window.tolerance = config.Number("window_tolerance", {1e-12, 0.1});
  params.full.tolerance = config.Number("full_tolerance", {1e-12, 0.1});
  return params;
}

LoopParams LoadLoop(const Config& config) {
  LoopParams params;
  params.constellation = LoadConstellation(config.Section("constellation"));
  params.gap = LoadConstellation(config.Section("gap_constellation"));
  params.min_pairs_by_shape = static_cast<size_t>(config.Integer("min_pairs_by_shape", 3, 40));
  params.min_distance = config.Number("min_distance_m", kPositive);
  params.recent_distance = config.Number("recent_distance_m", kPositive);
  params.search_radius = config.Number("search_radius_m", kPositive);
  params.gate_chi2 = config.Number("gate_chi2", kPositive);
  params.max_rmse = config.Number("max_rmse_m", kPositive);
  params.same_cone = config.Number("same_cone_m", {0.01, 2.0});
  return params;
}

TrackMapParams LoadMap(const Config& config) {
  TrackMapParams params;
  params.graph = LoadGraph(config.Section("graph"));
  params.filter = LoadFilter(config.Section("cones"));
  params.keyframe_distance = config.Number("keyframe_distance_m", {0.05, 20.0});
  params.keyframe_angle = config.Number("keyframe_angle_rad", {0.01, 3.0});
  params.max_keyframes = static_cast<size_t>(
      config.Integer("max_keyframes", static_cast<int>(params.graph.window_poses) + 1, 5000));
  params.max_open_keyframes = static_cast<size_t>(
      config.Integer("max_open_keyframes", static_cast<int>(params.max_keyframes), 5000));
  params.full_solve_keyframes =
      static_cast<size_t>(config.Integer("full_solve_keyframes", 1, 10000));
  params.max_landmarks =
      static_cast<size_t>(config.Integer("max_landmarks", 1, static_cast<int>(kMaxGlobalMapCones)));
  params.min_sightings = config.Integer("min_sightings", 1, 100);
  params.covariance_inflation = config.Number("covariance_inflation", {1.0, 1000.0});
  params.cone_sigma = config.Number("cone_sigma_m", {1e-3, 1.0});
  params.association_gate = config.Number("association_gate_m", {0.1, 5.0});
  params.memory_distance = config.Number("memory_distance_m", kPositive);
  params.loop = LoadLoop(config.Section("loop"));
  return params;
}

LocaliserParams LoadLocaliser(const Config& config) {
  LocaliserParams params;
  params.filter = LoadFilter(config.Section("cones"));
  params.constellation = LoadConstellation(config.Section("constellation"));
  params.gate_chi2 = config.Number("gate_chi2", kPositive);
  params.gate_distance = config.Number("gate_distance_m", {0.1, 5.0});
  params.covariance_inflation = config.Number("covariance_inflation", {1.0, 1000.0});
  params.cone_sigma = config.Number("cone_sigma_m", {1e-3, 1.0});
  params.min_match_share = config.Number("min_match_share", {1e-3, 1.0});
  params.max_unmatched = config.Integer("max_unmatched", 1, 1000);
  return params;
}

/// Where systemd lets a service keep its state; empty where it was not started by systemd.
std::string StateDirectory() {
  const char* directories = std::getenv("STATE_DIRECTORY");
  const std::string all = directories == nullptr ? "" : directories;
  return all.substr(0, all.find(':'));
}

MapStoreParams LoadStore(const Config& config) {
  MapStoreParams params;
  params.directory = config.Text("directory");
  if (params.directory == "state") params.directory = StateDirectory();
  if (params.directory == "none") params.directory.clear();
  params.resume_within = config.Number("resume_within_s", kPositive);
  params.max_journal_bytes = int64_t{1024} * 1024 * config.Integer("max_journal_mib", 1, 4096);
  return params;
}

/// None where there is none yet. One that cannot be read must not keep the car from making another.
std::optional<MapFile> MapOfLastDrive(const std::string& directory) {
  const std::string file = directory + "/map.yaml";
  if (directory.empty() || !std::filesystem::exists(file)) return std::nullopt;
  try {
    return LoadMapFile(file);
  } catch (const MapFileError& error) {
    std::cerr << "global_mapper: " << error.what() << ": not raced on\n";
    return std::nullopt;
  }
}

}  // namespace

GlobalMapperConfig LoadGlobalMapperConfig(const Config& config) {
  GlobalMapperConfig result;
  result.params.map = LoadMap(config);
  result.params.localiser = LoadLocaliser(config.Section("localisation"));
  result.params.odometry = LoadOdometry(config.Section("odometry"));
  result.params.min_lap_distance = config.Number("min_lap_distance_m", kPositive);
  const Config files = config.Section("files");
  result.store = LoadStore(files);
  const std::string known_map = files.Text("known_map");
  const Config race_line = config.Section("race_line");
  result.race_line = LoadRaceLineParams(race_line);
  result.race_line_ahead = race_line.Number("ahead_m", {20.0, 200.0});
  config.Finish();
  if (known_map == "none") return result;
  if (known_map == "state") {
    result.known_map = MapOfLastDrive(result.store.directory);
    return result;
  }
  try {
    result.known_map = LoadMapFile(known_map);
  } catch (const MapFileError& error) {
    throw ConfigError(error.what());
  }
  return result;
}

}  // namespace hairpin
