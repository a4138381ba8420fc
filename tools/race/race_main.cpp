// hairpin-race: drives the simulated car round a track with the whole stack, and reports.
// `tools/drive` builds and calls it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "daemons/mission_manager/missions.hpp"
#include "tools/race/race.hpp"
#include "tools/race/summary.hpp"
#include "tools/report/report_html.hpp"

namespace hairpin {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

struct Arguments {
  std::string track;  // empty: the mission's own
  uint64_t seed = 1;
  std::string mission = "autocross";
  std::string map;  // file, for the trackdrive
  int laps = 0;     // 0: as many as the mission has
  bool in_process = false;
  std::string can;
  bool attach = false;
  std::string sensors = "cones";
  bool log_scans = false;
  double speed = -1.0;  // not given
  double speed_cap = 0.0;
  double patience = RaceOptions{}.patience;
  std::vector<std::string> faults;
  std::vector<std::string> overrides;
  std::string out;
  std::string config_dir;
  std::string program_dir;
  std::string logs_dir;
  bool json = false;
};

struct Mission {
  const char* name;
  int32_t number;  // as in VEHICLE
};

constexpr Mission kMissions[] = {{"autocross", vehicle_t::MISSION_AUTOCROSS},
                                 {"trackdrive", vehicle_t::MISSION_TRACKDRIVE},
                                 {"acceleration", vehicle_t::MISSION_ACCELERATION},
                                 {"skidpad", vehicle_t::MISSION_SKIDPAD},
                                 {"brake_test", vehicle_t::MISSION_BRAKE_TEST},
                                 {"inspection", vehicle_t::MISSION_INSPECTION},
                                 {"manual", vehicle_t::MISSION_MANUAL}};

std::vector<std::string> MissionNames() {
  std::vector<std::string> names;
  for (const Mission& mission : kMissions) names.emplace_back(mission.name);
  return names;
}

int32_t NumberOf(const std::string& mission) {
  const auto* found = std::find_if(std::begin(kMissions), std::end(kMissions),
                                   [&](const Mission& known) { return known.name == mission; });
  return found->number;
}

bool IsOnAStraight(const std::string& mission) {
  return mission == "acceleration" || mission == "brake_test";
}

/// A mission that nobody can drive here.
class MissionError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

void RequireDrivable(const std::string& mission, int laps) {
  const int32_t number = NumberOf(mission);
  if (number == vehicle_t::MISSION_MANUAL) throw MissionError("mission manual is the driver's");
  const std::string problem = MissionProblem(number);
  if (!problem.empty()) throw MissionError(problem);
  if (IsOnAStraight(mission) && laps > 1) throw MissionError("--laps: a straight has one run");
}

void Define(CLI::App& app, Arguments& arguments) {
  app.add_option("--track", arguments.track,
                 "track file (own YAML, PacSim, FSSIM, EUFS CSV), or a name in config/tracks "
                 "(default: `default`; of the missions on a straight, `acceleration`)");
  app.add_option("--seed", arguments.seed, "seed of all noise")->capture_default_str();
  app.add_option("--mission", arguments.mission,
                 "autocross: drive on sight, and map; trackdrive: race on a map; acceleration: a "
                 "straight of 75 m; brake_test: the same until RES Stop is pressed at 40 km/h. One "
                 "that cannot be driven yet is refused by name")
      ->check(CLI::IsMember(MissionNames()))
      ->capture_default_str();
  app.add_option("--sensors", arguments.sensors,
                 "what the simulator feeds: `cones` and messages, as pipelines and drivers report "
                 "them, or `raw`: both LiDARs' packets, CAN and the GNSS receiver's serial port")
      ->check(CLI::IsMember({"cones", "raw"}))
      ->capture_default_str();
  app.add_flag("--log-scans", arguments.log_scans,
               "with raw sensors: LIDAR_FRONT and LIDAR_TOP into the log, 12 MB a second");
  app.add_option(
         "--map", arguments.map,
         "map of the track, from an autocross (default: a lap of autocross is driven first)")
      ->check(CLI::ExistingFile);
  app.add_option("--laps", arguments.laps,
                 "laps to drive (default: autocross 1, trackdrive 10; a straight has one run)")
      ->check(CLI::Range(1, 50));
  app.add_option(
         "--fault", arguments.faults,
         "`SOURCE off at T s [for D s]`, counted from Go; SOURCE is a pipeline (fusion, lidar, "
         "camera; with raw sensors lidar_front, lidar_top), a sensor or a daemon (repeatable)")
      ->allow_extra_args(false);
  app.add_option("--speed-cap", arguments.speed_cap, "drive no faster than this [m/s]")
      ->check(CLI::Range(1.0, 40.0));
  app.add_option("--speed", arguments.speed,
                 "at most this many times real time once the car is Ready, 0: as fast as it goes "
                 "(default 1; with --in-process 0)")
      ->check(CLI::Range(0.0, 1000.0));
  app.add_option("--patience", arguments.patience,
                 "a daemon that has not answered for so long counts as dead [s]; more on a machine "
                 "that is slower than the car's")
      ->capture_default_str()
      ->check(CLI::Range(0.05, 60.0));
  app.add_flag("--in-process", arguments.in_process,
               "all daemons in one process, on memq://; repeatable to the byte");
  app.add_flag("--can{cannelloni}", arguments.can,
               "the car speaks CAN, and can_gateway runs between it and the rest; --can=can0: over "
               "that interface of the kernel instead of UDP");
  app.add_flag("--attach", arguments.attach,
               "drive with the daemons that run here already (systemd's) and their own configs")
      ->excludes("--in-process")
      ->excludes("--sensors");
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

/// One start of the car.
struct Leg {
  std::string mission;
  int laps = 1;
  uint64_t seed = 1;
  std::string map;  // to race on; empty: none
  std::string out;
  std::vector<std::string> faults;
};

std::vector<Leg> LegsOf(const Arguments& arguments) {
  Leg leg{arguments.mission, arguments.laps, arguments.seed, "", arguments.out, arguments.faults};
  const bool trackdrive = leg.mission == "trackdrive";
  if (leg.laps == 0) leg.laps = trackdrive ? 10 : 1;
  leg.map = trackdrive ? arguments.map : "";
  if (!trackdrive || !leg.map.empty()) return {leg};
  const Leg first{"autocross", 1, arguments.seed, "", arguments.out + "/autocross", {}};
  leg.seed = arguments.seed + 1;  // another start: the sensors' errors are drawn anew
  leg.map = first.out + "/map.yaml";
  leg.out = arguments.out + "/trackdrive";
  return {first, leg};
}

std::vector<std::string> LegOverrides(const Leg& leg, double speed_cap) {
  std::vector<std::string> overrides{
      "simulator.referee.laps=" + std::to_string(leg.laps),
      "simulator.race_control.mission=" + std::to_string(NumberOf(leg.mission)),
      "global_mapper.files.known_map=" + (leg.map.empty() ? "none" : leg.map)};
  if (leg.mission == "brake_test") {  // by the rules: from 40 km/h, within 10 m
    overrides.emplace_back("simulator.race_control.res_stop_speed_mps=11.2");
    overrides.emplace_back("simulator.referee.braking_distance_m=10");
  }
  if (leg.mission == "autocross" || leg.mission == "trackdrive")
    overrides.push_back("mission_manager." + leg.mission + "_laps=" + std::to_string(leg.laps));
  if (speed_cap > 0.0) {
    const std::string cap = std::to_string(speed_cap);
    overrides.push_back("path_tracker.max_speed_mps=" + cap);
    overrides.push_back("path_tracker.race_max_speed_mps=" + cap);
  }
  return overrides;
}

RaceOptions ToOptions(const Arguments& arguments, const Leg& leg) {
  RaceOptions options;
  options.track = LoadTrack(TrackFile(arguments));
  options.seed = leg.seed;
  options.in_process = arguments.in_process;
  options.attach = arguments.attach;
  options.speed = arguments.speed >= 0.0 ? arguments.speed : arguments.in_process ? 0.0 : 1.0;
  options.can = arguments.can;
  options.log_scans = arguments.log_scans;
  options.patience = arguments.patience;
  const SensorLevel level = arguments.sensors == "raw" ? SensorLevel::kRaw : SensorLevel::kCones;
  const std::vector<std::string> sources =
      arguments.attach ? Simulator::Sources() : FaultSources(level, !options.can.empty());
  for (const std::string& text : leg.faults) options.faults.push_back(ParseFault(text, sources));
  // The map of this run belongs to this run; --set may say otherwise.
  std::vector<std::string> overrides{"global_mapper.files.directory=" + leg.out};
  overrides.insert(overrides.end(), arguments.overrides.begin(), arguments.overrides.end());
  options.stack = {arguments.config_dir, arguments.program_dir, leg.out, overrides, level};
  for (const std::string& text : LegOverrides(leg, arguments.speed_cap))
    options.stack.overrides.push_back(text);
  options.log_file = leg.out + "/log.lcmlog";
  options.receiver_file = leg.out + "/receiver.raw";
  return options;
}

struct LegResult {
  RaceOutcome outcome;
  RunLog log;
  nlohmann::json report;
};

/// Empty where it was interrupted.
std::optional<LegResult> RunLeg(const Arguments& arguments, const Leg& leg) {
  const RaceOptions options = ToOptions(arguments, leg);
  std::filesystem::create_directories(leg.out);
  std::cerr << options.track.name << ", seed " << options.seed << ": writing " << leg.out << '\n';
  LegResult result;
  result.outcome = RunRace(options, stop_requested);
  if (result.outcome.interrupted) {
    std::cerr << "interrupted; the log so far is " << options.log_file << '\n';
    return std::nullopt;
  }
  result.log = LoadRunLog(options.log_file);
  RunContext context = ToContext(options, result.outcome);
  context.faults = leg.faults;
  result.report = EvaluateRun(result.log, context);
  result.report["answers_missed"] = result.outcome.answers_missed;
  result.report["mission"] = leg.mission;
  WriteReport(leg.out, result.report, result.log);
  return result;
}

int Drive(const Arguments& arguments) {
  const std::vector<Leg> legs = LegsOf(arguments);
  std::optional<LegResult> result = RunLeg(arguments, legs.front());
  if (!result) return kExitFailure;
  bool clean = IsClean(result->outcome.result);
  if (legs.size() > 1 && result->outcome.result.finished) {
    const nlohmann::json autocross = result->report;
    result = RunLeg(arguments, legs.back());
    if (!result) return kExitFailure;
    clean = clean && IsClean(result->outcome.result);
    AddAutocross(autocross, result->report);
    WriteReport(arguments.out, result->report, result->log);
  }
  if (arguments.json) {
    std::cout << result->report.dump(2) << '\n';
  } else {
    std::cout << Summary(result->report, arguments.out);
  }
  return clean ? 0 : kExitFailure;
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
    RequireDrivable(arguments.mission, arguments.laps);
    if (arguments.track.empty())
      arguments.track = IsOnAStraight(arguments.mission) ? "acceleration" : "default";
    if (arguments.out.empty())
      arguments.out = DefaultOutDir(arguments.logs_dir, arguments.track, arguments.seed);
    return Drive(arguments);
  } catch (const MissionError& error) {
    std::cerr << "drive: " << error.what() << '\n';
    return kExitUsage;
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
