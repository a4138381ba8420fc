#include <benchmark/benchmark.h>

#include "tests/unit/path_tracker/closed_loop.hpp"

namespace hairpin {
namespace {

constexpr int64_t kStart = 1'700'000'000'000'000;

// One simulated second: 100 velocities with their commands, 50 words of the watchdog, 20 of the
// mission manager, 10 paths.
void OneSecondOfDriving(benchmark::State& state) {
  const test::Points points = test::PathBuilder().Straight(4).Arc(6, 0.15).Arc(8, -0.2).Build();
  PathInput path;
  for (size_t i = 0; i < points.size(); i += 5) path.points.push_back(points[i]);
  path.num_seen = path.points.size() - 6;
  path.seen_length = 15.0;
  PathTracker tracker(test::ShippedParams());
  int64_t utime = kStart;
  for (auto _ : state) {
    for (int i = 0; i < 100; ++i) {
      utime += 10'000;
      if (i % 2 == 0) tracker.TakePipelineStatus({utime, false, 12.0});
      if (i % 5 == 0) tracker.TakeAsState({utime, true, false});
      path.utime = utime - 100'000;
      if (i % 10 == 0) tracker.TakePath(path);
      benchmark::DoNotOptimize(tracker.Answer(utime, Twist2{6.0, 0.1, 0.3}));
    }
  }
}
BENCHMARK(OneSecondOfDriving)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hairpin
