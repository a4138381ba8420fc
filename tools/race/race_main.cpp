// hairpin-race: drives the simulated car round a track with the whole stack, and reports.
// `tools/drive` builds and calls it.
#include <CLI/CLI.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "tools/race/race.hpp"
#include "tools/race/summary.hpp"
#include "tools/report/report_html.hpp"

namespace hairpin {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

struct Arguments {
  std::string track = "default";
  uint64_t seed = 1;
  int laps = 1;
  bool in_process = false;
  bool can = false;
  bool attach = false;
  double speed = -1.0;  // not given
  double speed_cap = 0.0;
  std::vector<std::string> faults;
  std::vector<std::string> overrides;
  std::string out;
  std::string config_dir;
  std::string program_dir;
  std::string logs_dir;
  bool json = false;
};

void Define(CLI::App& app, Arguments& arguments) {
  app.add_option("--track", arguments.track,
                 "track file (own YAML, PacSim, FSSIM, EUFS CSV), or a name in config/tracks")
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "seed of all noise")->capture_default_str();
  app.add_option("--laps", arguments.laps, "laps to drive")
      ->check(CLI::Range(1, 50))
      ->capture_default_str();
  app.add_option(
         "--fault", arguments.faults,
         "`SOURCE off at T s [for D s]`, counted from Go; SOURCE is a pipeline (fusion, lidar, "
         "camera), a sensor or a daemon (repeatable)")
      ->allow_extra_args(false);
  app.add_option("--speed-cap", arguments.speed_cap, "drive no faster than this [m/s]")
      ->check(CLI::Range(1.0, 40.0));
  app.add_option("--speed", arguments.speed,
                 "at most this many times real time, 0: as fast as it goes "
                 "(default 1; with --in-process 0)")
      ->check(CLI::Range(0.0, 1000.0));
  app.add_flag("--in-process", arguments.in_process,
               "all daemons in one process, on memq://; repeatable to the byte");
  app.add_flag("--can", arguments.can,
               "the car speaks CAN, and can_gateway runs between it and the rest");
  app.add_flag("--attach", arguments.attach,
               "drive with the daemons that run here already (systemd's) and their own configs")
      ->excludes("--in-process");
  app.add_option("--set", arguments.overrides,
                 "DAEMON.KEY=VALUE in place of a config file's value (repeatable)")
      ->allow_extra_args(false);
  app.add_option("--out", arguments.out,
                 "folder of report and log (default: logs/TIME_TRACK_SEED)");
  app.add_flag("--json", arguments.json, "print report.json on stdout");
  app.add_option("--config-dir", arguments.config_dir, "folder of the .yaml files")
      ->required()
      ->group("");
  app.add_option("--program-dir", arguments.program_dir, "folder of the daemons")
      ->required()
      ->group("");
  app.add_option("--logs-dir", arguments.logs_dir, "where --out lies if not given")
      ->required()
      ->group("");
}

std::string TrackFile(const Arguments& arguments) {
  if (std::filesystem::exists(arguments.track)) return arguments.track;
  std::string named = arguments.config_dir + "/tracks/" + arguments.track + ".yaml";
  if (std::filesystem::exists(named)) return named;
  throw TrackError(arguments.track + ": no such file, nor " + named);
}

RaceOptions ToOptions(const Arguments& arguments) {
  RaceOptions options;
  options.track = LoadTrack(TrackFile(arguments));
  options.seed = arguments.seed;
  options.in_process = arguments.in_process;
  options.attach = arguments.attach;
  options.speed = arguments.speed >= 0.0 ? arguments.speed : arguments.in_process ? 0.0 : 1.0;
  options.can = arguments.can;
  const std::vector<std::string> sources =
      arguments.attach ? Simulator::Sources() : FaultSources(options.can);
  for (const std::string& text : arguments.faults)
    options.faults.push_back(ParseFault(text, sources));
  options.stack = {arguments.config_dir, arguments.program_dir, arguments.out, arguments.overrides};
  options.stack.overrides.push_back("simulator.referee.laps=" + std::to_string(arguments.laps));
  options.stack.overrides.push_back("mission_manager.autocross_laps=" +
                                    std::to_string(arguments.laps));
  if (arguments.speed_cap > 0.0) {
    options.stack.overrides.push_back("path_tracker.max_speed_mps=" +
                                      std::to_string(arguments.speed_cap));
  }
  options.log_file = arguments.out + "/log.lcmlog";
  return options;
}

int Drive(const Arguments& arguments) {
  const RaceOptions options = ToOptions(arguments);
  std::filesystem::create_directories(arguments.out);
  std::cerr << options.track.name << ", seed " << options.seed << ": writing " << arguments.out
            << '\n';
  const RaceOutcome outcome = RunRace(options, stop_requested);
  if (outcome.interrupted) {
    std::cerr << "interrupted; the log so far is " << options.log_file << '\n';
    return kExitFailure;
  }
  const RunLog log = LoadRunLog(options.log_file);
  RunContext context = ToContext(options, outcome);
  context.faults = arguments.faults;
  nlohmann::json report = EvaluateRun(log, context);
  report["answers_missed"] = outcome.answers_missed;
  WriteReport(arguments.out, report, log);
  if (arguments.json) {
    std::cout << report.dump(2) << '\n';
  } else {
    std::cout << Summary(report, arguments.out);
  }
  return IsClean(outcome.result) ? 0 : kExitFailure;
}

int Main(int argc, char** argv) {
  CLI::App app("Drives the simulated car round a track with the whole stack, and reports.",
               "drive");
  Arguments arguments;
  Define(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  struct sigaction action {};
  action.sa_handler = [](int) { stop_requested = 1; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  try {
    if (arguments.out.empty())
      arguments.out = DefaultOutDir(arguments.logs_dir, arguments.track, arguments.seed);
    return Drive(arguments);
  } catch (const FaultError& error) {
    std::cerr << "drive: " << error.what() << '\n';
    return kExitUsage;
  } catch (const TrackError& error) {
    std::cerr << "drive: " << error.what() << '\n';
    return kExitConfig;
  } catch (const ConfigError& error) {
    std::cerr << "drive: " << error.what() << '\n';
    return kExitConfig;
  } catch (const std::exception& error) {
    std::cerr << "drive: " << error.what() << '\n';
    return kExitFailure;
  }
}

}  // namespace
}  // namespace hairpin

int main(int argc, char** argv) { return hairpin::Main(argc, argv); }
