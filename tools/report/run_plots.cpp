#include <algorithm>
#include <cmath>

#include "tools/report/chart.hpp"
#include "tools/report/mode_changes.hpp"
#include "tools/report/pictures.hpp"
#include "tools/report/trajectory.hpp"

namespace hairpin {
namespace {

constexpr double kWidth = 1040.0;
constexpr double kHeight = 300.0;
constexpr size_t kMaxPoints = 1500;  // more than a screen can show

using Values = std::vector<Eigen::Vector2d>;

Values Thinned(const Values& values) {
  const size_t stride = values.size() / kMaxPoints + 1;
  Values thinned;
  for (size_t i = 0; i < values.size(); i += stride) thinned.push_back(values[i]);
  return thinned;
}

double DrivenDistance(const RunLog& log) {
  return log.truth.empty() ? 0.0 : log.truth.back().distance_m;
}

Values TrueSpeeds(const RunLog& log) {
  Values speeds;
  for (const truth_t& truth : log.truth)
    speeds.emplace_back(truth.distance_m, std::hypot(truth.vx_mps, truth.vy_mps));
  return speeds;
}

/// `value(command)` over the distance driven at its time, while the controller follows a path.
template <class Value>
Values OverDistance(const RunLog& log, Value&& value) {
  const TrueTrajectory trajectory(log);
  const DrivingPhase phase(log);
  Values values;
  for (const drive_command_t& command : log.drive_commands) {
    if (command.action != drive_command_t::ACTION_DRIVE || !phase.IsDriving(command.utime))
      continue;
    const auto state = trajectory.At(command.utime);
    if (state) values.emplace_back(state->distance, value(command));
  }
  return values;
}

/// Backgrounds of the modes; returns those that occur, in order of appearance.
std::vector<MapMode> DrawModes(const RunLog& log, Chart& chart) {
  const TrueTrajectory trajectory(log);
  const auto changes = ModeChanges(log);
  std::vector<MapMode> modes;
  for (size_t i = 0; i < changes.size(); ++i) {
    const auto from = trajectory.At(changes[i].utime);
    const auto to = i + 1 < changes.size() ? trajectory.At(changes[i + 1].utime) : std::nullopt;
    const std::string name = NameOf(changes[i].mode);
    chart.Band(from ? from->distance : 0.0, to ? to->distance : DrivenDistance(log), "mode " + name,
               name + ": " + changes[i].cause);
    if (std::find(modes.begin(), modes.end(), changes[i].mode) == modes.end())
      modes.push_back(changes[i].mode);
  }
  return modes;
}

}  // namespace

Svg DrawSpeed(const RunLog& log, const nlohmann::json& report) {
  const Values speeds = TrueSpeeds(log);
  const Values targets =
      OverDistance(log, [](const drive_command_t& c) { return c.target_speed_mps; });
  double top = 1.0;
  for (const auto* list : {&speeds, &targets}) {
    for (const Eigen::Vector2d& value : *list) top = std::max(top, value.y());
  }
  const ChartText text{"Speed over distance", Provenance(report), "distance driven [m]",
                       "speed [m/s]"};
  Chart chart(kWidth, kHeight, text, {0.0, std::max(DrivenDistance(log), 1.0)}, {0.0, 1.08 * top});
  std::vector<Chart::LegendEntry> legend{{"driven", "ours", true}, {"commanded", "target", true}};
  for (const MapMode mode : DrawModes(log, chart)) {
    legend.push_back({NameOf(mode), std::string("mode ") + NameOf(mode), false});
  }
  chart.XTicks();
  chart.Line(Thinned(targets), "target");
  chart.Line(Thinned(speeds), "ours");
  chart.Legend(legend);
  return chart.svg();
}

Svg DrawLateralError(const RunLog& log, const nlohmann::json& report) {
  constexpr double kLeastRange = 0.2;  // m
  const Values errors =
      OverDistance(log, [](const drive_command_t& c) { return c.lateral_error_m; });
  double top = kLeastRange;
  for (const Eigen::Vector2d& error : errors) top = std::max(top, 1.08 * std::abs(error.y()));
  const ChartText text{"Distance from the path", Provenance(report), "distance driven [m]",
                       "left of the path [m]"};
  Chart chart(kWidth, kHeight - 60.0, text, {0.0, std::max(DrivenDistance(log), 1.0)}, {-top, top});
  chart.XTicks();
  chart.Line(Thinned(errors), "ours");
  return chart.svg();
}

}  // namespace hairpin
