#include "tools/report/path_metrics.hpp"

#include <algorithm>
#include <cmath>

#include "tools/report/trajectory.hpp"

namespace hairpin {
namespace {

constexpr double kStep = 0.1;   // m between tested points
constexpr int kNumSteps = 154;  // to the end of the last bin, 15.5 m, which rounds to none
constexpr double kLengthTolerance = 1e-6;  // m: a path cut at exactly 15 m may have lost a rounding

/// Corners of the part of the path that cones support, in map.
std::vector<Eigen::Vector2d> SeenPart(const track_t& path, const Pose2& T_map_local) {
  std::vector<Eigen::Vector2d> points;
  for (const path_point_t& point : path.path) {
    if (point.extrapolated) break;
    points.push_back(T_map_local * Eigen::Vector2d(point.x_m, point.y_m));
  }
  return points;
}

int LengthBin(const track_t& path) {
  if (!path.valid) return 0;
  const double length =
      std::clamp(path.seen_length_m + kLengthTolerance, 0.0, kNumPathMetres - 1.0);
  return static_cast<int>(std::floor(length));
}

}  // namespace

std::optional<double> LeavesTrackAt(const track_t& path, const Pose2& T_map_local,
                                    const TrackBand& band) {
  const auto points = SeenPart(path, T_map_local);
  if (points.empty()) return std::nullopt;
  // The first point may lie ahead of the car, where the path is already that long.
  double begin = (points[0] - T_map_local * Eigen::Vector2d(path.x_m, path.y_m)).norm();
  int step = static_cast<int>(std::ceil(begin / kStep));
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const double length = (points[i + 1] - points[i]).norm();
    for (; step <= kNumSteps && step * kStep <= begin + length; ++step) {
      const double share = length > 0.0 ? (step * kStep - begin) / length : 0.0;
      if (!band.Contains(points[i] + share * (points[i + 1] - points[i]))) return step * kStep;
    }
    begin += length;
  }
  return std::nullopt;
}

std::optional<PathMetrics> MeasurePaths(const RunLog& log) {
  if (!log.truth_track) return std::nullopt;
  const TrueTrajectory trajectory(log);
  const DrivingPhase phase(log);
  const TrackBand band(*log.truth_track);
  PathMetrics metrics;
  for (const track_t& path : log.tracks) {
    if (!phase.IsDriving(path.utime)) continue;
    const auto T_map_local =
        MomentaryMapFromLocal(trajectory, path.utime, {path.x_m, path.y_m, path.yaw_rad});
    if (!T_map_local) continue;
    ++metrics.count;
    metrics.invalid += path.valid ? 0 : 1;
    metrics.length[static_cast<size_t>(LengthBin(path))] += 1.0;
    const auto out = path.valid ? LeavesTrackAt(path, *T_map_local, band) : std::nullopt;
    const auto bin =
        out ? static_cast<size_t>(std::floor(*out + 0.5)) : metrics.out_of_track.size();
    if (bin < metrics.out_of_track.size()) metrics.out_of_track[bin] += 1.0;
  }
  if (metrics.count == 0) return std::nullopt;
  for (double& share : metrics.length) share = 100.0 * share / metrics.count;
  for (double& share : metrics.out_of_track)
    share = 100.0 * share / std::max(metrics.count - metrics.invalid, 1);
  return metrics;
}

nlohmann::json ToJson(const std::optional<PathMetrics>& metrics) {
  if (!metrics) {
    return {{"count", 0},
            {"invalid", 0},
            {"full_length_percent", nullptr},
            {"length_percent", nullptr},
            {"out_of_track_percent", nullptr}};
  }
  return {{"count", metrics->count},
          {"invalid", metrics->invalid},
          {"full_length_percent", metrics->length.back()},
          {"length_percent", metrics->length},
          {"out_of_track_percent", metrics->out_of_track}};
}

}  // namespace hairpin
