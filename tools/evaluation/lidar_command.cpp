#include <memory>
#include <optional>

#include "common/program.hpp"
#include "tools/evaluation/commands.hpp"
#include "tools/evaluation/figures.hpp"
#include "tools/evaluation/lidar_evaluation.hpp"
#include "tools/evaluation/lidar_picture.hpp"
#include "tools/evaluation/lidar_sources.hpp"
#include "tools/evaluation/recording_error.hpp"

namespace hairpin {
namespace {

struct LidarOptions {
  std::string run, map, log;
  std::string config_dir = "config";
  std::vector<std::string> overrides;
  int rings = 64;
  bool json = false;
  std::optional<int64_t> picture;
  std::string out;
};

void DefineOptions(CLI::App& app, LidarOptions& options) {
  CLI::Option* run = app.add_option("--run", options.run, "recorded scans (.fscn.xz)");
  CLI::Option* map = app.add_option("--map", options.map, "surveyed cones (.csv: x_m,y_m,colour)");
  CLI::Option* log =
      app.add_option("--log", options.log,
                     "LCM log of LIDAR_*, VELOCITY, TRUTH and TRUTH_TRACK, in place of --run");
  run->needs(map)->excludes(log);
  map->needs(run);
  app.add_option("--rings", options.rings, "of the 64 recorded: 32 leaves out every second one")
      ->check(CLI::IsMember({64, 32, 16}))
      ->capture_default_str();
  AddConfigDirOption(app, options.config_dir);
  app.add_option("--set", options.overrides,
                 "KEY=VALUE in place of the config file's value (repeatable)")
      ->allow_extra_args(false);
  app.add_flag("--json", options.json, "print one JSON object");
  CLI::Option* picture = app.add_option("--picture", options.picture, "draw this scan");
  picture->needs(app.add_option("--out", options.out, "the picture's .svg file")->needs(picture));
}

void Run(const LidarOptions& options) {
  if (options.run.empty() && options.log.empty())
    throw CLI::RequiredError("--run with --map, or --log,");
  const Config config = Config::Load(options.config_dir, "lidar_cone_detector", options.overrides);
  const LidarConeDetectorNodeParams params = LoadLidarConeDetectorParams(config);
  LidarFigures figures;
  int64_t scans = 0;
  const auto add = [&](const EvaluatedScan& scan) {
    figures.Add(scan.truth, scan.detections, scan.sensor, scan.ms);
    ++scans;
    if (options.picture != scan.number) return;
    WriteFile(options.out, DrawScan(scan.number, scan.cloud, scan.detector.heights(),
                                    scan.detector.candidates(), scan.truth, scan.detections));
  };
  if (options.log.empty()) {
    DetectInRecording(options.run, options.map, options.rings, params, add);
  } else {
    DetectInLog(options.log, params, add);
  }
  if (options.picture && *options.picture >= scans) {
    throw RecordingError("--picture " + std::to_string(*options.picture) +
                         ": there are scans 0 to " + std::to_string(scans - 1));
  }
  PrintFigures(figures.ToJson(), options.json);
}

}  // namespace

void AddLidarCommand(CLI::App& app) {
  CLI::App* lidar = app.add_subcommand(
      "lidar", "lidar_cone_detector on recorded scans, or on a log with its truth");
  const auto options = std::make_shared<LidarOptions>();
  DefineOptions(*lidar, *options);
  lidar->callback([options] { Run(*options); });
}

}  // namespace hairpin
