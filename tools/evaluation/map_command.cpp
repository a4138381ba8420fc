#include <algorithm>
#include <filesystem>
#include <memory>

#include "tools/evaluation/commands.hpp"
#include "tools/evaluation/figures.hpp"
#include "tools/evaluation/recording_error.hpp"
#include "tools/report/map_comparison.hpp"
#include "tools/report/pictures.hpp"
#include "tools/report/run_metrics.hpp"
#include "tools/report/true_track.hpp"

namespace hairpin {
namespace {

struct MapOptions {
  std::string log;
  std::string picture;
  bool json = false;
};

/// Distance that the car had driven where it came nearest to a point.
double DistanceAt(const RunLog& log, const Eigen::Vector2d& point) {
  const auto nearest =
      std::min_element(log.truth.begin(), log.truth.end(), [&](const truth_t& a, const truth_t& b) {
        return (Eigen::Vector2d(a.x_m, a.y_m) - point).norm() <
               (Eigen::Vector2d(b.x_m, b.y_m) - point).norm();
      });
  return nearest == log.truth.end() ? 0.0 : nearest->distance_m;
}

/// Error of every matched cone, along the way.
nlohmann::json ErrorAlongTrack(const RunLog& log, const MapComparison& comparison) {
  const std::vector<TrueCone> truth = TrueCones(*log.truth_track);
  std::vector<std::pair<double, double>> errors;
  for (const ComparedCone& cone : comparison.cones) {
    if (cone.match)
      errors.emplace_back(DistanceAt(log, truth[*cone.match].position), cone.distance);
  }
  std::sort(errors.begin(), errors.end());
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [distance, error] : errors)
    list.push_back({{"distance_m", distance}, {"error_m", error}});
  return list;
}

void Run(const MapOptions& options) {
  if (!std::filesystem::exists(options.log)) throw RecordingError(options.log + ": no such file");
  const RunLog log = LoadRunLog(options.log);
  const auto comparison = CompareMap(log);
  nlohmann::json figures = ToJson(comparison);
  figures["of"] = log.global_maps.empty() ? "LOCAL_MAP" : "GLOBAL_MAP";
  if (options.json)
    figures["error_along_track"] =
        comparison ? ErrorAlongTrack(log, *comparison) : nlohmann::json();
  if (!options.picture.empty()) {
    RunContext context;
    if (log.truth_track) {
      context.track = log.truth_track->name;
      context.seed = log.truth_track->seed;
    }
    WriteFile(options.picture, DrawTrack(log, EvaluateRun(log, context)).Standalone());
  }
  PrintFigures(figures, options.json);
}

}  // namespace

void AddMapCommand(CLI::App& app) {
  CLI::App* map = app.add_subcommand("map", "the global map of a run's log against the truth");
  const auto options = std::make_shared<MapOptions>();
  map->add_option("--log", options->log, "log.lcmlog of a simulated run, or of `truth`")
      ->required();
  map->add_option("--picture", options->picture, "draw track and map into this .svg file");
  map->add_flag("--json", options->json, "print one JSON object, with the error along the track");
  map->callback([options] { Run(*options); });
}

}  // namespace hairpin
