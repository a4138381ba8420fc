// hairpin-raceline: the line to race on, of a mapped track or a track file. `tools/raceline` builds
// and calls it.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <iostream>

#include "common/program.hpp"
#include "daemons/global_mapper/global_mapper_node.hpp"
#include "tools/line/line_study.hpp"

namespace hairpin {
namespace {

struct Arguments {
  std::vector<std::string> files;
  std::vector<std::string> overrides;
  std::string picture;
  std::string config_dir;
  bool json = false;
};

void Print(const nlohmann::json& figures) {
  const nlohmann::json& middle = figures.at("middle");
  std::printf(
      "%s: %.1f m in %.2f s, mean %.2f m/s, at most %.1f m/s; the middle: %.1f m in %.2f s, mean "
      "%.2f m/s\n  squared curvature %.3f 1/m (middle %.3f), a cone's line at least %.2f m off\n",
      figures.at("name").get<std::string>().c_str(), figures.at("length_m").get<double>(),
      figures.at("lap_time_s").get<double>(), figures.at("mean_speed_mps").get<double>(),
      figures.at("max_speed_mps").get<double>(), middle.at("length_m").get<double>(),
      middle.at("lap_time_s").get<double>(), middle.at("mean_speed_mps").get<double>(),
      figures.at("squared_curvature_per_m").get<double>(),
      middle.at("squared_curvature_per_m").get<double>(),
      figures.at("least_free_way_m").get<double>());
}

LineStudy Study(const std::string& file, const RaceLineParams& params) {
  try {
    return StudyLine(LoadLineInput(file), params);
  } catch (const std::invalid_argument& error) {  // no line fits it
    throw InputError(file + ": " + error.what());
  }
}

void Run(const Arguments& arguments) {
  std::vector<std::string> overrides;
  for (const std::string& text : arguments.overrides) overrides.push_back("race_line." + text);
  const RaceLineParams params =
      LoadGlobalMapperConfig(Config::Load(arguments.config_dir, "global_mapper", overrides))
          .race_line;
  nlohmann::json lines = nlohmann::json::array();
  for (const std::string& file : arguments.files) {
    const LineStudy study = Study(file, params);
    lines.push_back(ToJson(study));
    if (!arguments.json) Print(lines.back());
    if (arguments.picture.empty()) continue;
    std::ofstream stream(arguments.picture, std::ios::binary | std::ios::trunc);
    stream << DrawLine(study);
    if (!stream.flush()) throw std::runtime_error(arguments.picture + ": cannot be written");
  }
  if (arguments.json) std::cout << nlohmann::json{{"lines", lines}}.dump(2) << '\n';
}

int Main(int argc, char** argv) {
  CLI::App app("The line to race on, beside the middle of the track.", "raceline");
  Arguments arguments;
  app.add_option("files", arguments.files, "map.yaml of an autocross, or a track of any format")
      ->required();
  app.add_option("--picture", arguments.picture, "SVG file to write (of the last FILE)");
  app.add_option("--set", arguments.overrides,
                 "KEY=VALUE in place of one in the section race_line of global_mapper.yaml")
      ->allow_extra_args(false);
  app.add_flag("--json", arguments.json, "one JSON object on stdout");
  app.add_option("--config-dir", arguments.config_dir, "folder of the .yaml files")
      ->required()
      ->group("");
  app.footer("Exit: 0 done, 1 ran and failed, 2 wrong usage, 78 bad input.");
  return RunProgram(app, argc, argv, [&arguments] {
    Run(arguments);
    return 0;
  });
}

}  // namespace
}  // namespace hairpin

int main(int argc, char** argv) { return hairpin::Main(argc, argv); }
