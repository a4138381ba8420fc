#include <CLI/CLI.hpp>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/daemon.hpp"
#include "daemons/boundary_estimator/boundary_estimator_node.hpp"
#include "tools/evaluation/frame_picture.hpp"

namespace hairpin {
namespace {

struct PlannerOptions {
  std::string file;
  std::string config_dir = "config";
  std::vector<std::string> overrides;
  bool json = false;
  std::optional<size_t> picture;
  std::string out;
};

void DefinePlanner(CLI::App& app, PlannerOptions& options) {
  app.add_option("FILE", options.file, "recorded run: JSON list of frames")->required();
  app.add_option("--config-dir", options.config_dir, "folder of the .yaml files")
      ->envname("HAIRPIN_CONFIG_DIR")
      ->capture_default_str();
  app.add_option("--set", options.overrides,
                 "KEY=VALUE in place of the config file's value (repeatable)")
      ->allow_extra_args(false);
  app.add_flag("--json", options.json, "print one JSON object");
  CLI::Option* picture = app.add_option("--picture", options.picture, "draw this frame");
  picture->needs(app.add_option("--out", options.out, "the picture's .svg file")->needs(picture));
}

void PrintTable(const nlohmann::json& figures) {
  for (const auto& [key, value] : figures.items())
    std::cout << std::left << std::setw(30) << key << value << '\n';
}

void PrintFramesToLookAt(const PlannerReport& report) {
  std::cout << "frames that cross: ";
  for (size_t i = 0; i < report.frames.size(); ++i) {
    if (report.frames[i].crosses)
      std::cout << i << (report.frames[i].crosses_observed ? " " : "(unseen) ");
  }
  std::cout << "\nframes that fall short of the seen stretch: ";
  for (size_t i = 0; i < report.frames.size(); ++i) {
    if (report.frames[i].estimate.path.length < report.frames[i].seen_length) std::cout << i << ' ';
  }
  std::cout << '\n';
}

void Draw(const std::vector<RecordedFrame>& run, const PlannerReport& report, size_t frame,
          const std::string& out) {
  if (frame >= report.frames.size()) {
    throw RecordingError("--picture " + std::to_string(frame) + ": the run has frames 0 to " +
                         std::to_string(report.frames.size() - 1));
  }
  std::ofstream stream(out);
  stream << DrawFrame(run, frame, report.frames[frame]);
  if (!stream.flush()) throw std::runtime_error(out + ": cannot be written");
}

void RunPlanner(const PlannerOptions& options) {
  const Config config = Config::Load(options.config_dir, "boundary_estimator", options.overrides);
  const BoundaryEstimatorParams params = LoadBoundaryEstimatorParams(config);
  const std::vector<RecordedFrame> run = LoadRecordedRun(options.file);
  const PlannerReport report = EvaluatePlanner(run, params);
  if (options.picture) Draw(run, report, *options.picture, options.out);
  const nlohmann::json figures = ToJson(report);
  if (options.json) {
    std::cout << figures.dump(2) << '\n';
  } else {
    PrintTable(figures);
    PrintFramesToLookAt(report);
  }
}

int Fail(const std::exception& error, int code) {
  std::cerr << "hairpin-evaluate: " << error.what() << '\n';
  return code;
}

int Main(int argc, char** argv) {
  CLI::App app("Figures from recordings, for people or (--json) for machines", "hairpin-evaluate");
  app.require_subcommand(1);
  PlannerOptions options;
  CLI::App* planner = app.add_subcommand("planner", "boundary_estimator on a recorded run");
  DefinePlanner(*planner, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  try {
    RunPlanner(options);
    return 0;
  } catch (const ConfigError& error) {
    return Fail(error, kExitConfig);
  } catch (const RecordingError& error) {
    return Fail(error, kExitConfig);
  } catch (const std::exception& error) {
    return Fail(error, kExitFailure);
  }
}

}  // namespace
}  // namespace hairpin

int main(int argc, char** argv) { return hairpin::Main(argc, argv); }
