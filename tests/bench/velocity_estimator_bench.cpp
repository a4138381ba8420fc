#include <benchmark/benchmark.h>

#include "tests/unit/velocity_estimator/simulated_drive.hpp"

namespace hairpin {
namespace {

/// One period of 100 Hz: prediction and the updates of all sensors, GNSS every tenth.
void Cycle(benchmark::State& bench) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  SimulatedDrive drive(params.car, HardLap);
  VelocityEstimator estimator(params);
  for (auto _ : bench) {
    bench.PauseTiming();
    drive.Step();
    const Readings readings = drive.Measure();
    bench.ResumeTiming();
    Offer(estimator, readings);
    benchmark::DoNotOptimize(estimator.Advance(readings.imu->utime));
  }
}
BENCHMARK(Cycle)->Unit(benchmark::kMicrosecond);

/// The same, GNSS in each.
void CycleWithGnss(benchmark::State& bench) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  SimulatedDrive drive(params.car, HardLap);
  VelocityEstimator estimator(params);
  for (auto _ : bench) {
    bench.PauseTiming();
    Readings readings;
    while (!readings.gnss) {
      drive.Step();
      readings = drive.Measure();
    }
    bench.ResumeTiming();
    Offer(estimator, readings);
    benchmark::DoNotOptimize(estimator.Advance(readings.imu->utime));
  }
}
BENCHMARK(CycleWithGnss)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hairpin
