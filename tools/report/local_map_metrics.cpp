#include "tools/report/local_map_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/clock.hpp"
#include "tools/report/map_comparison.hpp"
#include "tools/report/statistics.hpp"
#include "tools/report/trajectory.hpp"
#include "tools/report/true_track.hpp"

namespace hairpin {
namespace {

Pose2 LocalPose(const local_map_t& local_map) {
  return {local_map.x_m, local_map.y_m, local_map.yaw_rad};
}

/// Nearest true cone within the gate, or none.
const TrueCone* Match(const std::vector<TrueCone>& truth, const Eigen::Vector2d& position_map) {
  const TrueCone* match = nullptr;
  double nearest = kMatchGate;
  for (const TrueCone& cone : truth) {
    const double distance = (cone.position - position_map).norm();
    if (distance > nearest) continue;
    nearest = distance;
    match = &cone;
  }
  return match;
}

/// Calls `visit(local_map index, cone, true cone or nullptr)` for every certain cone of every local
/// map while driving. The true pose of the moment places them, so that drift does not make a right
/// cone look false.
template <class Visitor>
void ForEachCertainCone(const RunLog& log, Visitor&& visit) {
  if (!log.truth_track) return;
  const auto truth = TrueCones(*log.truth_track);
  const TrueTrajectory trajectory(log);
  const DrivingPhase phase(log);
  for (size_t i = 0; i < log.local_maps.size(); ++i) {
    const local_map_t& local_map = log.local_maps[i];
    if (!phase.IsDriving(local_map.utime)) continue;
    const auto T_map_local =
        MomentaryMapFromLocal(trajectory, local_map.utime, LocalPose(local_map));
    if (!T_map_local) continue;
    for (const local_cone_t& cone : local_map.cones) {
      if (static_cast<double>(cone.existence) < kCertainExistence) continue;
      visit(i, cone, Match(truth, *T_map_local * Eigen::Vector2d(cone.x_m, cone.y_m)));
    }
  }
}

}  // namespace

ColourMetrics MeasureColours(const RunLog& log) {
  ColourMetrics metrics;
  ForEachCertainCone(log, [&](size_t i, const local_cone_t& cone, const TrueCone* match) {
    if (!match || (match->colour != ConeColour::kBlue && match->colour != ConeColour::kYellow))
      return;
    const double distance =
        (LocalPose(log.local_maps[i]).position() - Eigen::Vector2d(cone.x_m, cone.y_m)).norm();
    const auto end = std::lower_bound(kColourBinEnds.begin(), kColourBinEnds.end(), distance);
    if (end == kColourBinEnds.end()) return;
    const auto bin = static_cast<size_t>(end - kColourBinEnds.begin());
    const ConeColour colour = ColourOf(cone);
    ++metrics.count[bin];
    metrics.right[bin] += colour == match->colour ? 1 : 0;
    metrics.unknown[bin] += colour == ConeColour::kUnknown ? 1 : 0;
  });
  return metrics;
}

nlohmann::json ToJson(const ColourMetrics& metrics) {
  nlohmann::json accuracy = nlohmann::json::array();
  for (size_t bin = 0; bin < kColourBinEnds.size(); ++bin) {
    const bool any = metrics.count[bin] > 0;
    accuracy.push_back(
        any ? nlohmann::json(static_cast<double>(metrics.right[bin]) / metrics.count[bin])
            : nullptr);
  }
  return {{"bin_ends_m", kColourBinEnds},
          {"accuracy", accuracy},
          {"count", metrics.count},
          {"unknown", metrics.unknown}};
}

std::vector<double> FalsePositiveLifetimes(const RunLog& log) {
  std::map<std::pair<int64_t, int64_t>, double> lifetimes;
  ForEachCertainCone(log, [&](size_t i, const local_cone_t& cone, const TrueCone* match) {
    if (match) return;
    const local_map_t& local_map = log.local_maps[i];
    const bool last = i + 1 == log.local_maps.size();
    const double held = last ? 0.0 : SecondsBetween(local_map.utime, log.local_maps[i + 1].utime);
    lifetimes[{local_map.epoch, cone.id}] += held;
  });
  std::vector<double> list;
  list.reserve(lifetimes.size());
  for (const auto& [id, lifetime] : lifetimes) list.push_back(lifetime);
  return list;
}

nlohmann::json FalsePositiveJson(const std::vector<double>& lifetimes) {
  return {{"count", lifetimes.size()},
          {"p50", OrNull(Percentile(lifetimes, 50.0))},
          {"max", OrNull(Percentile(lifetimes, 100.0))}};
}

std::optional<Drift> MeasureDrift(const RunLog& log) {
  const TrueTrajectory trajectory(log);
  struct Ends {
    const local_map_t* first;
    const local_map_t* last;
    double duration() const { return SecondsBetween(first->utime, last->utime); }
  };
  std::map<int64_t, Ends> epochs;
  for (const local_map_t& local_map : log.local_maps) {
    if (!trajectory.At(local_map.utime)) continue;
    epochs.try_emplace(local_map.epoch, Ends{&local_map, &local_map}).first->second.last =
        &local_map;
  }
  const auto shorter = [](const auto& a, const auto& b) {
    return a.second.duration() < b.second.duration();
  };
  const auto longest = std::max_element(epochs.begin(), epochs.end(), shorter);
  if (longest == epochs.end()) return std::nullopt;
  const auto& [first, last] = longest->second;
  const auto T_map_local = MomentaryMapFromLocal(trajectory, first->utime, LocalPose(*first));
  const Pose2 reckoned = *T_map_local * LocalPose(*last);
  const Pose2 truth = trajectory.At(last->utime)->T_map_base;
  return Drift{(reckoned.position() - truth.position()).norm(),
               WrapAngle(reckoned.yaw - truth.yaw)};
}

nlohmann::json ToJson(const std::optional<Drift>& drift) {
  if (!drift) return {{"end_m", nullptr}, {"end_yaw_rad", nullptr}};
  return {{"end_m", OrNull(drift->position)}, {"end_yaw_rad", OrNull(drift->yaw)}};
}

}  // namespace hairpin
