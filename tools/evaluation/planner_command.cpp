#include <iostream>
#include <memory>
#include <optional>

#include "common/program.hpp"
#include "daemons/boundary_estimator/boundary_estimator_node.hpp"
#include "tools/evaluation/commands.hpp"
#include "tools/evaluation/figures.hpp"
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

void DefineOptions(CLI::App& app, PlannerOptions& options) {
  app.add_option("FILE", options.file, "recorded run: JSON list of frames")->required();
  AddConfigDirOption(app, options.config_dir);
  app.add_option("--set", options.overrides,
                 "KEY=VALUE in place of the config file's value (repeatable)")
      ->allow_extra_args(false);
  app.add_flag("--json", options.json, "print one JSON object");
  CLI::Option* picture = app.add_option("--picture", options.picture, "draw this frame");
  picture->needs(app.add_option("--out", options.out, "the picture's .svg file")->needs(picture));
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
  WriteFile(out, DrawFrame(run, frame, report.frames[frame]));
}

void Run(const PlannerOptions& options) {
  const Config config = Config::Load(options.config_dir, "boundary_estimator", options.overrides);
  const BoundaryEstimatorParams params = LoadBoundaryEstimatorParams(config);
  const std::vector<RecordedFrame> run = LoadRecordedRun(options.file);
  const PlannerReport report = EvaluatePlanner(run, params);
  if (options.picture) Draw(run, report, *options.picture, options.out);
  PrintFigures(ToJson(report), options.json);
  if (!options.json) PrintFramesToLookAt(report);
}

}  // namespace

void AddPlannerCommand(CLI::App& app) {
  CLI::App* planner = app.add_subcommand("planner", "boundary_estimator on a recorded run");
  const auto options = std::make_shared<PlannerOptions>();
  DefineOptions(*planner, *options);
  planner->callback([options] { Run(*options); });
}

}  // namespace hairpin
