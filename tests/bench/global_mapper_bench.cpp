// Batch and per-update times of the graph on a synthetic lap: 300 m, 150 cones, 600 poses, 12,300
// sightings, odometry sigma 0.02 m and 0.004 rad, sighting sigma 0.1 m; and on ten such laps.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <numeric>

#include "daemons/global_mapper/global_mapper_node.hpp"
#include "tests/support/synthetic_lap.hpp"

namespace hairpin {
namespace {

TrackMapParams Params() {
  KeepFreedMemory();
  const Config config = Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "global_mapper");
  return LoadGlobalMapperConfig(config).params.map;
}

/// Of this thread: what other programs on the machine take is not in it.
double CpuMilliseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

void Batch(benchmark::State& state) {
  const SyntheticLap lap(1);
  SyntheticLapDriver driver(Params().graph, lap.poses()[0]);
  for (const auto& step : lap.steps()) driver.Add(step);
  for (auto _ : state) {
    state.PauseTiming();
    PoseLandmarkGraph graph = driver.graph();
    state.ResumeTiming();
    if (!graph.SolveAll()) state.SkipWithError("the solver failed");
  }
}
BENCHMARK(Batch)->Unit(benchmark::kMillisecond);

/// Drives laps pose by pose as TrackMap does with the shipped config. Counters: CPU milliseconds
/// per pose of the last lap.
void Laps(benchmark::State& state) {
  const int laps = static_cast<int>(state.range(0));
  const SyntheticLap lap(1, laps);
  const TrackMapParams params = Params();
  for (auto _ : state) {
    SyntheticLapDriver driver(params.graph, lap.poses()[0]);
    std::vector<double> ms;
    for (const auto& step : lap.steps()) {
      const double start = CpuMilliseconds();
      if (!driver.Drive(step, params.max_keyframes, params.full_solve_keyframes))
        state.SkipWithError("the solver failed");
      ms.push_back(CpuMilliseconds() - start);
    }
    std::vector<double> last(ms.end() - SyntheticLap::kPoses, ms.end());
    const auto tail = last.end() - SyntheticLap::kPoses / 10;
    state.counters["last_tenth_ms"] =
        std::accumulate(tail, last.end(), 0.0) / (SyntheticLap::kPoses / 10);
    state.counters["lap_mean_ms"] =
        std::accumulate(last.begin(), last.end(), 0.0) / SyntheticLap::kPoses;
    std::sort(last.begin(), last.end());
    state.counters["p99_ms"] = last[SyntheticLap::kPoses * 99 / 100];
    state.counters["max_ms"] = last.back();
  }
}
BENCHMARK(Laps)->Arg(1)->Arg(2)->Arg(10)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace hairpin
