#include "tools/report/race_line_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/report/statistics.hpp"
#include "tools/report/trajectory.hpp"

namespace hairpin {
namespace {

// TRUTH's frame against the map's, as one line places them.
std::optional<Pose2> TruthFromMap(const TrueTrajectory& trajectory, const race_line_t& line) {
  const auto truth = trajectory.At(line.utime);
  if (!truth) return std::nullopt;
  return truth->T_map_base * Pose2{line.x_m, line.y_m, line.yaw_rad}.Inverse();
}

// How far each line's pose is from where the first line's frame puts the true one [m].
std::vector<double> LocalisationErrors(const RunLog& log) {
  const TrueTrajectory trajectory(log);
  const DrivingPhase phase(log);
  std::optional<Pose2> T_map_truth;
  std::vector<double> errors;
  for (const race_line_t& line : log.race_lines) {
    const auto T_truth_map = TruthFromMap(trajectory, line);
    if (!T_truth_map) continue;
    if (!T_map_truth) T_map_truth = T_truth_map->Inverse();
    if (!phase.IsDriving(line.utime)) continue;
    const Pose2 truth = *T_map_truth * trajectory.At(line.utime)->T_map_base;
    errors.push_back((truth.position() - Eigen::Vector2d(line.x_m, line.y_m)).norm());
  }
  return errors;
}

}  // namespace

nlohmann::json RaceLineJson(const RunLog& log) {
  if (log.race_lines.empty()) return nullptr;
  const DrivingPhase phase(log);
  std::vector<double> off;
  int commands = 0;
  int left = 0;
  bool before = false;
  for (const drive_command_t& command : log.drive_commands) {
    const bool drives =
        command.action == drive_command_t::ACTION_DRIVE && phase.IsDriving(command.utime);
    if (!drives) continue;
    const bool follows = command.on_race_line != 0;
    ++commands;
    if (follows) off.push_back(std::abs(command.lateral_error_m));
    if (before && !follows) ++left;
    before = follows;
  }
  const auto share = commands > 0
                         ? std::optional(100.0 * static_cast<double>(off.size()) / commands)
                         : std::nullopt;
  const std::vector<double> errors = LocalisationErrors(log);
  return {{"followed_percent", OrNull(share)},
          {"times_left", left},
          {"lateral_error_m",
           {{"rms", OrNull(RootMeanSquare(off))}, {"max", OrNull(Percentile(off, 100.0))}}},
          {"localisation_m",
           {{"rms", OrNull(RootMeanSquare(errors))}, {"max", OrNull(Percentile(errors, 100.0))}}}};
}

std::vector<std::vector<Eigen::Vector2d>> RaceLineOfALap(const RunLog& log) {
  constexpr double kStretch = 20.0;  // m of way between two lines that are drawn
  const TrueTrajectory trajectory(log);
  std::vector<std::vector<Eigen::Vector2d>> stretches;
  std::optional<double> last;
  for (const race_line_t& line : log.race_lines) {
    const auto truth = trajectory.At(line.utime);
    const auto T_truth_map = TruthFromMap(trajectory, line);
    if (!truth || !T_truth_map || (last && truth->distance < *last + kStretch)) continue;
    const auto lap =
        std::lower_bound(log.truth.begin(), log.truth.end(), line.utime,
                         [](const truth_t& t, int64_t utime) { return t.utime < utime; });
    if (lap != log.truth.end() && lap->lap > 0) break;
    last = truth->distance;
    double length = 0.0;
    std::vector<Eigen::Vector2d> stretch;
    for (const race_line_point_t& point : line.points) {
      stretch.push_back(*T_truth_map * Eigen::Vector2d(point.x_m, point.y_m));
      if (stretch.size() > 1) length += (stretch.back() - stretch[stretch.size() - 2]).norm();
      if (length > 1.5 * kStretch) break;
    }
    stretches.push_back(std::move(stretch));
  }
  return stretches;
}

}  // namespace hairpin
