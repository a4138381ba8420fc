#include <benchmark/benchmark.h>

#include "tests/unit/velocity_estimator/simulated_drive.hpp"

namespace hairpin {
namespace {

/// Twenty seconds of hard driving; `cycle` is one period of 100 Hz: prediction and the updates of
/// all sensors.
void HardDriving(benchmark::State& bench) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  SimulatedDrive drive(params.car, HardLap);
  std::vector<Readings> periods(2000);
  for (Readings& readings : periods) {
    drive.Step();
    readings = drive.Measure();
  }
  for (auto _ : bench) {
    VelocityEstimator estimator(params);
    for (const Readings& readings : periods) {
      Offer(estimator, readings);
      benchmark::DoNotOptimize(estimator.Advance(readings.imu->utime));
    }
  }
  const double cycles =
      static_cast<double>(bench.iterations()) * static_cast<double>(periods.size());
  bench.counters["cycle"] =
      benchmark::Counter(cycles, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(HardDriving)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hairpin
