#include <memory>

#include "common/program.hpp"
#include "tools/evaluation/commands.hpp"
#include "tools/evaluation/figures.hpp"
#include "tools/evaluation/run_evaluation.hpp"

namespace hairpin {
namespace {

struct RunOptions {
  std::string run, map, picture;
  std::string config_dir = "config";
  int rings = 64;
  bool json = false;
};

void Run(const RunOptions& options) {
  const auto load = [&](const char* daemon) { return Config::Load(options.config_dir, daemon); };
  MappedRunParams params{LoadLidarConeDetectorParams(load("lidar_cone_detector")),
                         LoadLocalMapperParams(load("local_mapper")),
                         LoadGlobalMapperConfig(load("global_mapper")), options.rings};
  params.global_mapper.known_map.reset();  // it is mapped, and nothing is kept
  params.global_mapper.store.directory.clear();
  const std::vector<SurveyedCone> survey = LoadSurveyedMap(options.map);
  const MappedRun run = MapRecording(options.run, survey, params);
  if (!options.picture.empty()) WriteFile(options.picture, DrawMappedRun(run, survey));
  PrintFigures(ToJson(run), options.json);
}

}  // namespace

void AddRunCommand(CLI::App& app) {
  CLI::App* run = app.add_subcommand(
      "run",
      "a recorded drive through lidar_cone_detector, local_mapper and global_mapper: its map "
      "against a surveyed one");
  const auto options = std::make_shared<RunOptions>();
  run->add_option("--run", options->run, "recorded scans with velocities (.fscn.xz)")->required();
  run->add_option("--map", options->map, "surveyed cones (.csv: x_m,y_m,colour)")->required();
  run->add_option("--rings", options->rings, "of the 64 recorded: 32 leaves out every second one")
      ->check(CLI::IsMember({64, 32, 16}))
      ->capture_default_str();
  AddConfigDirOption(*run, options->config_dir);
  run->add_option("--picture", options->picture, "draw survey, map and way into this .svg file");
  run->add_flag("--json", options->json, "print one JSON object");
  run->callback([options] { Run(*options); });
}

}  // namespace hairpin
