#include "tools/simulator/track_command.hpp"

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/program.hpp"
#include "tools/simulator/track_checks.hpp"
#include "tools/simulator/track_drawing.hpp"
#include "tools/simulator/track_formats.hpp"
#include "tools/simulator/track_generator.hpp"
#include "tools/simulator/track_geometry.hpp"

namespace hairpin {
namespace {

using nlohmann::json;

struct Arguments {
  GeneratorOptions generator;
  double length = 0.0;
  std::string event = "lap";
  std::string name;
  std::vector<std::string> files;
  std::string file;
  std::string out;
  std::string format = "hairpin";
  bool json = false;
};

struct Commands {
  CLI::App* generate;
  CLI::App* check;
  CLI::App* draw;
  CLI::App* convert;
};

CLI::App* AddCommand(CLI::App& app, const char* name, const char* what, Arguments& arguments) {
  CLI::App* command = app.add_subcommand(name, what);
  command->add_flag("--json", arguments.json, "one JSON object on stdout");
  return command;
}

Commands Define(CLI::App& app, Arguments& arguments) {
  app.require_subcommand(1);
  app.footer("Exit: 0 done, 1 ran and failed, 2 wrong usage, 78 bad input.");
  Commands commands{
      AddCommand(app, "generate",
                 "make a random track that obeys the rules, or the straight of an event",
                 arguments),
      AddCommand(app, "check",
                 "say what tracks are, and which rules they bend; 78 if one is refused", arguments),
      AddCommand(app, "draw", "draw a track as an SVG picture", arguments),
      AddCommand(
          app, "convert",
          "rewrite a track of any format, or a saved map, as our own, PacSim YAML or EUFS CSV",
          arguments)};
  commands.generate->add_option("--seed", arguments.generator.seed, "of all choices")
      ->capture_default_str();
  commands.generate
      ->add_option("--length", arguments.length,
                   "of the lap [m] (default: 240 to 440, by the seed)")
      ->check(CLI::Range(200.0, 500.0));
  commands.generate->add_option("--clutter", arguments.generator.clutter, "things beside the track")
      ->check(CLI::Range(0, 200))
      ->capture_default_str();
  commands.generate
      ->add_option("--event", arguments.event,
                   "`lap`: random, as the options above say; `acceleration`: the straight of that "
                   "event, always the same")
      ->check(CLI::IsMember({"lap", "acceleration"}))
      ->capture_default_str();
  commands.generate->add_option("--name", arguments.name, "of the track (default: seed N)");
  commands.generate->add_option("--out", arguments.out, "file to write")->required();
  commands.check
      ->add_option("files", arguments.files, "own YAML, saved map, PacSim or FSSIM YAML, EUFS CSV")
      ->required();
  commands.draw->add_option("file", arguments.file, "track of any format")->required();
  commands.draw->add_option("--out", arguments.out, "SVG file to write")->required();
  commands.convert->add_option("file", arguments.file, "track of any format")->required();
  commands.convert->add_option("out", arguments.out, "file to write")->required();
  commands.convert->add_option("--to", arguments.format, "format to write")
      ->check(CLI::IsMember({"hairpin", "pacsim", "eufs"}))
      ->capture_default_str();
  return commands;
}

json Describe(const Track& track) {
  return {{"name", track.name},
          {"closed", track.closed},
          {"length_m", Length(CentreLine(track), false)},
          {"cones",
           {{"left", track.left.size()},
            {"right", track.right.size()},
            {"others", track.others.size()}}},
          {"clutter", track.clutter.size()},
          {"rule_violations", CheckRules(track)}};
}

void Print(const std::string& file, const json& track) {
  std::cout << file << ": " << track.at("format").get<std::string>() << ", "
            << (track.at("closed").get<bool>() ? "lap of " : "open, ")
            << std::lround(track.at("length_m").get<double>())
            << " m, cones: " << track.at("cones").at("left") << " left, "
            << track.at("cones").at("right") << " right, " << track.at("cones").at("others")
            << " others; clutter: " << track.at("clutter") << '\n';
  for (const json& violation : track.at("rule_violations")) {
    std::cout << "  rule: " << violation.get<std::string>() << '\n';
  }
}

int Check(const Arguments& arguments) {
  json tracks = json::array();
  int code = 0;
  for (const std::string& file : arguments.files) {
    json result{{"file", file}};
    try {
      const LoadedTrack loaded = LoadTrackOfAnyFormat(file);
      result.update(Describe(loaded.track));
      result["format"] = NameOf(loaded.format);
      if (!arguments.json) Print(file, result);
    } catch (const TrackError& error) {
      std::cerr << error.what() << '\n';
      result["refused"] = error.what();
      code = kExitConfig;
    }
    tracks.push_back(result);
  }
  if (arguments.json) std::cout << json{{"tracks", tracks}}.dump(2) << '\n';
  return code;
}

void Report(const Arguments& arguments, const Track& track) {
  std::cerr << arguments.out << " written\n";
  if (!arguments.json) return;
  json result = Describe(track);
  result["out"] = arguments.out;
  std::cout << result.dump(2) << '\n';
}

void Generate(Arguments arguments, bool has_length) {
  if (has_length) arguments.generator.length = arguments.length;
  const bool straight = arguments.event == "acceleration";
  Track track = straight ? AccelerationTrack() : GenerateTrack(arguments.generator);
  if (!arguments.name.empty()) track.name = arguments.name;
  SaveTrack(track, arguments.out);
  Report(arguments, track);
}

void Draw(const Arguments& arguments) {
  const Track track = LoadTrack(arguments.file);
  std::ofstream stream(arguments.out);
  if (stream) stream << DrawTrack(track);
  if (!stream.flush()) throw std::runtime_error(arguments.out + ": cannot be written");
  Report(arguments, track);
}

void Convert(const Arguments& arguments) {
  const Track track = LoadTrack(arguments.file);
  if (arguments.format == "hairpin") {
    SaveTrack(track, arguments.out);
  } else {
    std::ofstream stream(arguments.out);
    stream << (arguments.format == "pacsim" ? ToPacsim(track) : ToEufs(track));
    if (!stream.flush()) throw std::runtime_error(arguments.out + ": cannot be written");
  }
  Report(arguments, track);
}

int Run(const Commands& commands, const Arguments& arguments) {
  if (*commands.check) return Check(arguments);
  if (*commands.generate) Generate(arguments, commands.generate->count("--length") > 0);
  if (*commands.draw) Draw(arguments);
  if (*commands.convert) Convert(arguments);
  return 0;
}

}  // namespace

int RunTrackCommand(int argc, const char* const* argv) {
  CLI::App app("Makes, checks, draws and converts tracks.", "hairpin-track");
  Arguments arguments;
  const Commands commands = Define(app, arguments);
  return RunProgram(app, argc, argv, [&] { return Run(commands, arguments); });
}

}  // namespace hairpin
