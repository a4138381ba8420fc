#pragma once

#include <Eigen/Core>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "common/geometry.hpp"
#include "hairpin/track_t.hpp"
#include "tools/report/run_log.hpp"
#include "tools/report/true_track.hpp"

namespace hairpin {

inline constexpr int kNumPathMetres = 16;  // 0 to 15 m ahead, as in the paper's figure 6
using PathHistogram = std::array<double, kNumPathMetres>;

/// Share of paths by their length and by where they leave the track [paper IV-C, both histograms].
/// Judged are the paths published while the car drives, and only the part of each that cones
/// support.
struct PathMetrics {
  int count = 0;           // TRACK messages while driving
  int invalid = 0;         // of them, without a path
  PathHistogram length{};  // % of all, by whole metres; the last holds 15 m and more, the first
                           // those without a path
  PathHistogram out_of_track{};  // % of the valid, first point outside nearest to that many metres
                                 // along the path
};

/// Distance along the seen part of the path at which it first lies off the track, tested each 0.1 m
/// up to 15.5 m. `T_map_local` takes the message's points to map. Empty where it stays on the
/// track.
std::optional<double> LeavesTrackAt(const track_t& path, const Pose2& T_map_local,
                                    const TrackBand& band);

/// Empty where no path was published while driving, or the truth is not known.
std::optional<PathMetrics> MeasurePaths(const RunLog& log);

/// The keys of `path`; null where nothing was measured.
nlohmann::json ToJson(const std::optional<PathMetrics>& metrics);

}  // namespace hairpin
