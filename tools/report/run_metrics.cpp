#include "tools/report/run_metrics.hpp"

#include <cmath>

#include "common/clock.hpp"
#include "tools/report/local_map_metrics.hpp"
#include "tools/report/map_comparison.hpp"
#include "tools/report/mode_changes.hpp"
#include "tools/report/path_metrics.hpp"
#include "tools/report/race_line_metrics.hpp"
#include "tools/report/statistics.hpp"
#include "tools/report/trajectory.hpp"

namespace hairpin {
namespace {

nlohmann::json ToJson(const LapResult& lap) {
  return {{"finished", lap.finished},
          {"time_s", OrNull(lap.time_s)},
          {"cones_hit", lap.cones_hit},
          {"off_course", lap.off_course},
          {"max_speed_mps", OrNull(lap.max_speed_mps)},
          {"mean_speed_mps", OrNull(lap.mean_speed_mps)},
          {"reason", lap.reason},
          {"lap_times_s", lap.lap_times_s}};
}

nlohmann::json LatencyJson(const std::map<std::string, std::vector<double>>& latency_ms) {
  nlohmann::json stages = nlohmann::json::object();
  for (const auto& [stage, samples] : latency_ms) stages[stage] = PercentilesJson(samples);
  return stages;
}

/// Age of the path that each command follows, while driving.
nlohmann::json DataAgeJson(const RunLog& log) {
  const DrivingPhase phase(log);
  std::vector<double> ages_ms;
  for (const drive_command_t& command : log.drive_commands) {
    if (command.action != drive_command_t::ACTION_DRIVE || command.track_utime == 0) continue;
    if (phase.IsDriving(command.utime))
      ages_ms.push_back(1e3 * SecondsBetween(command.track_utime, command.utime));
  }
  return PercentilesJson(ages_ms);
}

/// Errors of the velocity estimate against the truth, while driving.
nlohmann::json VelocityJson(const RunLog& log) {
  const TrueTrajectory trajectory(log);
  const DrivingPhase phase(log);
  std::vector<double> vx;
  std::vector<double> vy;
  std::vector<double> yaw_rate;
  for (const velocity_t& estimate : log.velocities) {
    if (!estimate.valid || !phase.IsDriving(estimate.utime)) continue;
    const auto truth = trajectory.At(estimate.utime);
    if (!truth) continue;
    vx.push_back(estimate.vx_mps - truth->velocity.vx);
    vy.push_back(estimate.vy_mps - truth->velocity.vy);
    yaw_rate.push_back(estimate.yaw_rate_radps - truth->velocity.yaw_rate);
  }
  return {{"vx_rms_mps", OrNull(RootMeanSquare(vx))},
          {"vy_rms_mps", OrNull(RootMeanSquare(vy))},
          {"yaw_rate_rms_radps", OrNull(RootMeanSquare(yaw_rate))}};
}

/// Distance from the path that the controller saw, while driving.
nlohmann::json LateralErrorJson(const RunLog& log) {
  const DrivingPhase phase(log);
  std::vector<double> errors;
  for (const drive_command_t& command : log.drive_commands) {
    const bool follows =
        command.action == drive_command_t::ACTION_DRIVE && phase.IsDriving(command.utime);
    if (follows) errors.push_back(std::abs(command.lateral_error_m));
  }
  return {{"rms", OrNull(RootMeanSquare(errors))}, {"max", OrNull(Percentile(errors, 100.0))}};
}

nlohmann::json LogJson(const RunLog& log) {
  return {{"events", log.events},
          {"undecodable", log.undecodable},
          {"over_limit", log.over_limit},
          {"skipped_bytes", log.skipped_bytes}};
}

}  // namespace

nlohmann::json EvaluateRun(const RunLog& log, const RunContext& context) {
  return {{"seed", context.seed},
          {"track", context.track},
          {"build", context.build},
          {"faults", context.faults},
          {"real_time_factor", OrNull(context.real_time_factor)},
          {"lap", ToJson(context.lap)},
          {"map", ToJson(CompareMap(log))},
          {"local_map", ToJson(CompareLocalMaps(log))},
          {"path", ToJson(MeasurePaths(log))},
          {"modes", ToJson(ModeChanges(log), DrivingPhase(log).go_utime())},
          {"latency_ms", LatencyJson(context.latency_ms)},
          {"data_age_ms", DataAgeJson(log)},
          {"velocity", VelocityJson(log)},
          {"lateral_error_m", LateralErrorJson(log)},
          {"race_line", RaceLineJson(log)},
          {"drift", ToJson(MeasureDrift(log))},
          {"false_positive_lifetime_s", FalsePositiveJson(FalsePositiveLifetimes(log))},
          {"colour", ToJson(MeasureColours(log))},
          {"log", LogJson(log)}};
}

}  // namespace hairpin
