#include <benchmark/benchmark.h>

#include "tests/support/oval_track.hpp"
#include "tests/support/simulator_setup.hpp"
#include "tools/simulator/simulator.hpp"
#include "tools/simulator/track_area.hpp"

namespace hairpin {
namespace {

void VehicleSecond(benchmark::State& bench) {
  Vehicle vehicle(ShippedSimulatorParams().vehicle, ShippedCar(), {}, 10.0);
  VehicleInput input;
  input.steering_angle = 0.1;
  input.wheel_torque.fill(20.0);
  for (auto _ : bench) vehicle.Advance(input, 1000);
}
BENCHMARK(VehicleSecond)->Unit(benchmark::kMillisecond);

// Everything the simulator computes and publishes in a second, nobody listening.
void SimulatorSecond(benchmark::State& bench) {
  Transport transport("memq://");
  Bus bus(transport, "simulator", 1);
  Simulator simulator(ShippedSimulatorParams(), ShippedCar(),
                      OvalTrack({80.0, 30.0, 3.5, 3.0, 3.0}), 1, bus);
  for (auto _ : bench) {
    for (int i = 0; i < 100; ++i) {
      simulator.Step();
      transport.Drain();
    }
  }
}
BENCHMARK(SimulatorSecond)->Unit(benchmark::kMillisecond);

void TrackAreaContains(benchmark::State& bench) {
  const TrackArea area(OvalTrack({80.0, 30.0, 3.5, 3.0, 3.0}));
  double s = 0.0;
  for (auto _ : bench) benchmark::DoNotOptimize(area.Contains(OvalPose(s += 0.7).position()));
}
BENCHMARK(TrackAreaContains);

}  // namespace
}  // namespace hairpin
