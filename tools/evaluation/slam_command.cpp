#include <algorithm>
#include <map>
#include <memory>

#include "common/program.hpp"
#include "daemons/global_mapper/global_mapper_node.hpp"
#include "tools/evaluation/commands.hpp"
#include "tools/evaluation/figures.hpp"
#include "tools/evaluation/slam_evaluation.hpp"

namespace hairpin {
namespace {

const std::map<std::string, NoiseReading> kReadings{{"bearing_range", NoiseReading::kBearingRange},
                                                    {"covariance", NoiseReading::kCovariance},
                                                    {"information", NoiseReading::kInformation}};

struct SlamOptions {
  std::string file;
  std::string config_dir = "config";
  NoiseReading noise = NoiseReading::kInformation;
  int full_solve_steps = 200;
  bool json = false;
};

void Run(const SlamOptions& options) {
  const Config config = Config::Load(options.config_dir, "global_mapper");
  GraphParams params = LoadGlobalMapperConfig(config).params.map.graph;
  params.window.loss_scale = params.full.loss_scale = 0.0;  // the associations are true
  const SlamDataset dataset = LoadSlamDataset(options.file, options.noise);
  nlohmann::json figures = ToJson(EvaluateSlam(dataset, params, options.full_solve_steps));
  figures["landmarks"] = dataset.num_landmarks;
  figures["noise_read_as"] = std::find_if(kReadings.begin(), kReadings.end(), [&](const auto& r) {
                               return r.second == options.noise;
                             })->first;
  PrintFigures(figures, options.json);
}

}  // namespace

void AddSlamCommand(CLI::App& app) {
  CLI::App* slam = app.add_subcommand(
      "slam", "global_mapper's graph driven through a landmark-SLAM benchmark, step by step");
  const auto options = std::make_shared<SlamOptions>();
  slam->add_option("--victoria", options->file, "the dataset, in the format of victoria_park.txt")
      ->required();
  slam->add_option("--noise", options->noise,
                   "what the file's noise figures are: information (the default), covariance, or "
                   "bearing_range: covariances, those of landmarks turned into bearing and range")
      ->transform(CLI::Transformer(kReadings));
  slam->add_option("--full-solve-steps", options->full_solve_steps,
                   "steps between two solves of everything where no loop closes")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  AddConfigDirOption(*slam, options->config_dir);
  slam->add_flag("--json", options->json, "print one JSON object");
  slam->callback([options] { Run(*options); });
}

}  // namespace hairpin
