#include <filesystem>
#include <memory>

#include "common/daemon.hpp"
#include "common/program.hpp"
#include "daemons/velocity_estimator/velocity_estimator_node.hpp"
#include "tools/evaluation/commands.hpp"
#include "tools/evaluation/figures.hpp"
#include "tools/evaluation/velocity_evaluation.hpp"
#include "tools/evaluation/velocity_picture.hpp"

namespace hairpin {
namespace {

struct VelocityOptions {
  std::string run;
  std::string config_dir = "config";
  std::string car = "amz2017";
  std::vector<std::string> overrides;
  std::string picture;
  bool json = false;
};

RecordingScale LoadScale(const std::string& folder, double wheel_radius) {
  const Config config = Config::Load(folder, "recording");
  RecordingScale scale{.motor_rpm_per_mps = config.Number("motor_rpm_per_mps", {1.0, 10000.0}),
                       .wheel_radius = wheel_radius};
  config.Finish();
  return scale;
}

void Run(const VelocityOptions& options) {
  const std::string folder = options.config_dir + "/cars/" + options.car;
  const VelocityEstimatorParams params =
      LoadVelocityEstimatorParams(Config::Load(folder, "velocity_estimator", options.overrides))
          .estimator;
  const RecordingScale scale = LoadScale(folder, params.car.wheel_radius);
  const VelocityReport report = EvaluateVelocity(LoadSensorRecording(options.run, scale), params);
  if (!options.picture.empty()) WriteFile(options.picture, DrawVelocityReport(report, params.car));
  nlohmann::json figures = ToJson(report, params);
  figures["run"] = std::filesystem::path(options.run).lexically_normal().string();
  figures["car"] = options.car;
  figures["build"] = BuildId();
  PrintFigures(figures, options.json);
}

}  // namespace

void AddVelocityCommand(CLI::App& app) {
  CLI::App* velocity =
      app.add_subcommand("velocity", "velocity_estimator on the sensors of a recorded drive");
  const auto options = std::make_shared<VelocityOptions>();
  velocity->add_option("--run", options->run, "folder of the recording's .csv files")->required();
  AddConfigDirOption(*velocity, options->config_dir);
  velocity->add_option("--car", options->car, "the car that drove: a folder of CONFIG_DIR/cars")
      ->capture_default_str();
  velocity
      ->add_option("--set", options->overrides,
                   "KEY=VALUE in place of the config file's value (repeatable)")
      ->allow_extra_args(false);
  velocity->add_option("--picture", options->picture,
                       "draw the driven line against GPS and the speeds, to this .svg file");
  velocity->add_flag("--json", options->json, "print one JSON object");
  velocity->callback([options] { Run(*options); });
}

}  // namespace hairpin
