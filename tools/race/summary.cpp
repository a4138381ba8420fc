#include "tools/race/summary.hpp"

#include <ctime>
#include <filesystem>
#include <iomanip>
#include <numeric>
#include <sstream>

#include "common/daemon.hpp"

namespace hairpin {
namespace {

// A figure with its unit, or a dash where it could not be computed.
std::string Figure(const nlohmann::json& value, int digits, const std::string& unit) {
  if (!value.is_number()) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value.get<double>() << unit;
  return text.str();
}

double Worst(const nlohmann::json& percents) {
  double worst = 0.0;
  for (const auto& percent : percents) {
    if (percent.is_number()) worst = std::max(worst, percent.get<double>());
  }
  return worst;
}

// Of a trackdrive: each lap, and the autocross before it.
std::string LapLines(const nlohmann::json& report) {
  const auto& times = report.at("lap").at("lap_times_s");
  std::string text;
  if (times.size() > 1) {
    text += "  laps       ";
    for (const auto& time : times) text += " " + Figure(time, 2, "");
    text += " s\n";
  }
  if (report.contains("autocross")) {
    const auto& lap = report.at("autocross").at("lap");
    text += "  autocross   " + Figure(lap.at("time_s"), 2, " s") + ", mean " +
            Figure(lap.at("mean_speed_mps"), 1, " m/s") + "; the trackdrive is " +
            Figure(report.at("speed_ratio"), 2, "") + " times as fast\n";
  }
  return text;
}

}  // namespace

bool IsClean(const RaceResult& result) {
  return result.finished && result.cones_hit == 0 && result.off_course == 0;
}

RunContext ToContext(const RaceOptions& options, const RaceOutcome& outcome) {
  RunContext context;
  context.track = options.track.name;
  context.seed = static_cast<int64_t>(options.seed);
  context.build = BuildId();
  context.real_time_factor = outcome.real_time_factor;
  context.latency_ms = outcome.latencies_ms;
  context.lap.finished = outcome.result.finished;
  context.lap.cones_hit = outcome.result.cones_hit;
  context.lap.off_course = outcome.result.off_course;
  context.lap.max_speed_mps = outcome.result.max_speed_mps;
  context.lap.mean_speed_mps = outcome.result.mean_speed_mps;
  context.lap.lap_times_s = outcome.result.lap_times_s;
  if (const auto& laps = outcome.result.lap_times_s; !laps.empty()) {
    context.lap.time_s = std::accumulate(laps.begin(), laps.end(), 0.0);
  }
  context.lap.reason = outcome.result.reason;
  return context;
}

void AddAutocross(const nlohmann::json& autocross, nlohmann::json& trackdrive) {
  trackdrive["autocross"] = {
      {"lap", autocross.at("lap")}, {"map", autocross.at("map")}, {"seed", autocross.at("seed")}};
  const auto& before = autocross.at("lap").at("mean_speed_mps");
  const auto& after = trackdrive.at("lap").at("mean_speed_mps");
  trackdrive["speed_ratio"] = before.is_number() && after.is_number() && before > 0.0
                                  ? nlohmann::json(after.get<double>() / before.get<double>())
                                  : nlohmann::json();
}

std::string Summary(const nlohmann::json& report, const std::string& out_dir) {
  const auto& lap = report.at("lap");
  const auto& map = report.at("map");
  const auto& path = report.at("path");
  std::ostringstream text;
  text << report.at("track").get<std::string>() << ", seed " << report.at("seed") << ": "
       << lap.at("reason").get<std::string>() << '\n'
       << "  lap time    " << Figure(lap.at("time_s"), 2, " s") << ", mean "
       << Figure(lap.at("mean_speed_mps"), 1, " m/s") << ", max "
       << Figure(lap.at("max_speed_mps"), 1, " m/s") << '\n'
       << LapLines(report) << "  penalties   " << lap.at("cones_hit") << " cones hit, "
       << lap.at("off_course") << " times off course\n"
       << "  map         " << map.at("matched") << " cones matched, " << map.at("missed")
       << " missed, " << map.at("false") << " false, RMSE " << Figure(map.at("rmse_m"), 2, " m")
       << '\n'
       << "  paths       " << Figure(path.at("full_length_percent"), 1, " %")
       << " reach 15 m, at worst " << Figure(Worst(path.at("out_of_track_percent")), 2, " %")
       << " leave the track in one metre\n"
       << "  speed of run  x" << Figure(report.at("real_time_factor"), 1, "") << " real time\n"
       << "  report      " << out_dir << "/report.html\n";
  return text.str();
}

std::string DefaultOutDir(const std::string& logs_dir, const std::string& track, uint64_t seed) {
  const std::time_t now = std::time(nullptr);
  std::ostringstream name;
  name << std::put_time(std::localtime(&now), "%Y%m%d-%H%M%S") << '_'
       << std::filesystem::path(track).stem().string() << "_s" << seed;
  return (std::filesystem::path(logs_dir) / name.str()).string();
}

}  // namespace hairpin
