#include "tools/evaluation/planner_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/clock.hpp"

namespace hairpin {
namespace {

constexpr double kTolerance = 1e-6;  // m: sums of steps

bool Crosses(const Polyline& path, const std::vector<Segment>& boundaries) {
  for (size_t i = 1; i < path.size(); ++i) {
    const Segment step{path[i - 1], path[i]};
    const auto hits = [&](const Segment& boundary) { return Intersect(step, boundary); };
    if (std::any_of(boundaries.begin(), boundaries.end(), hits)) return true;
  }
  return false;
}

template <class Predicate>
double Percent(const std::vector<PlannerFrame>& frames, Predicate predicate) {
  const auto count = std::count_if(frames.begin(), frames.end(), predicate);
  return 100.0 * static_cast<double>(count) / static_cast<double>(frames.size());
}

// The smallest value that at least `share` of all do not exceed.
double Quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return values[static_cast<size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace

PlannerReport EvaluatePlanner(const std::vector<RecordedFrame>& run,
                              const BoundaryEstimatorParams& params) {
  const RecordedTrack track(run);
  BoundaryEstimator estimator(params);
  const MonotonicClock clock;
  PlannerReport report;
  for (size_t i = 0; i < run.size(); ++i) {
    PlannerFrame& frame = report.frames.emplace_back();
    const int64_t begin = clock.NowMicros();
    frame.estimate = estimator.Estimate(run[i].T_map_base, run[i].cones);
    frame.time_ms = 1e3 * SecondsBetween(begin, clock.NowMicros());
    frame.seen_length = track.SeenLength(run, i, PlannerReport::kFullLength);
    Polyline path;
    for (const PathPoint& point : frame.estimate.path.points) path.push_back(point.position);
    frame.crosses = Crosses(Clipped(path, PlannerReport::kFullLength), track.boundaries());
    frame.crosses_observed = Crosses(Clipped(path, frame.seen_length), track.boundaries());
  }
  return report;
}

nlohmann::json ToJson(const PlannerReport& report) {
  constexpr double kFull = PlannerReport::kFullLength - kTolerance;
  const auto& frames = report.frames;
  std::vector<double> times;
  times.reserve(frames.size());
  for (const PlannerFrame& frame : frames) times.push_back(frame.time_ms);
  const auto percent = [&](auto predicate) { return Percent(frames, predicate); };
  using Frame = const PlannerFrame&;
  return {
      {"frames", frames.size()},
      {"reach_15m_percent", percent([](Frame f) { return f.estimate.path.length >= kFull; })},
      {"reach_seen_percent",
       percent([](Frame f) { return f.estimate.path.length >= f.seen_length - kTolerance; })},
      {"cross_15m_percent", percent([](Frame f) { return f.crosses; })},
      {"cross_observed_percent", percent([](Frame f) { return f.crosses_observed; })},
      {"reach_15m_on_cones_percent",
       percent([](Frame f) { return f.estimate.path.seen_length >= kFull; })},
      {"reach_seen_on_cones_percent",
       percent([](Frame f) { return f.estimate.path.seen_length >= f.seen_length - kTolerance; })},
      {"seen_14m_percent", percent([](Frame f) { return f.seen_length >= 14.0; })},
      {"no_path_percent", percent([](Frame f) { return !f.estimate.valid; })},
      {"ms_median", Quantile(times, 0.5)},
      {"ms_p95", Quantile(times, 0.95)},
      {"ms_max", Quantile(times, 1.0)},
  };
}

}  // namespace hairpin
