#include "tools/report/mode_changes.hpp"

#include <algorithm>

#include "common/clock.hpp"
#include "tools/report/statistics.hpp"
#include "tools/report/trajectory.hpp"

namespace hairpin {
namespace {

/// Seconds since the newest of `messages` up to `utime`, if the pipeline was fresh before and is
/// not now.
std::optional<double> Silence(bool was_fresh, bool is_fresh, const std::vector<cones_t>& messages,
                              int64_t utime) {
  if (!was_fresh || is_fresh) return std::nullopt;
  const auto earlier = [](int64_t time, const cones_t& cones) { return time < cones.utime; };
  const auto next = std::upper_bound(messages.begin(), messages.end(), utime, earlier);
  if (next == messages.begin()) return std::nullopt;
  return SecondsBetween((next - 1)->utime, utime);
}

std::optional<double> Reaction(const RunLog& log, const pipeline_status_t& before,
                               const pipeline_status_t& now) {
  // An empty optional is less than any other.
  return std::max({Silence(before.fusion_fresh, now.fusion_fresh, log.cones_fusion, now.utime),
                   Silence(before.lidar_fresh, now.lidar_fresh, log.cones_lidar, now.utime),
                   Silence(before.camera_fresh, now.camera_fresh, log.cones_camera, now.utime)});
}

ModeChange ToChange(const pipeline_status_t& status) {
  return {status.utime, static_cast<MapMode>(status.map_mode), status.reason, std::nullopt};
}

}  // namespace

std::vector<ModeChange> ModeChanges(const RunLog& log) {
  std::vector<ModeChange> changes;
  const int64_t go = DrivingPhase(log).go_utime().value_or(0);
  const pipeline_status_t* before = nullptr;
  for (const pipeline_status_t& status : log.pipeline_status) {
    ModeChange change = ToChange(status);
    if (before && before->map_mode != status.map_mode)
      change.reaction = Reaction(log, *before, status);
    if (changes.empty() || changes.back().mode != change.mode) {
      if (changes.size() == 1 && status.utime <= go) changes.clear();
      changes.push_back(std::move(change));
    }
    before = &status;
  }
  if (!changes.empty() && changes.front().utime < go) {
    changes.front().utime = go;
    changes.front().reaction.reset();
  }
  return changes;
}

nlohmann::json ToJson(const std::vector<ModeChange>& changes, std::optional<int64_t> go_utime) {
  nlohmann::json list = nlohmann::json::array();
  for (const ModeChange& change : changes) {
    std::optional<double> t;
    if (go_utime) t = SecondsBetween(*go_utime, change.utime);
    list.push_back({{"t_s", OrNull(t)},
                    {"mode", NameOf(change.mode)},
                    {"cause", change.cause},
                    {"reaction_s", OrNull(change.reaction)}});
  }
  return list;
}

}  // namespace hairpin
