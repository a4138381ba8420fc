#include <benchmark/benchmark.h>

#include <random>

#include "daemons/boundary_estimator/boundary_estimator_node.hpp"

namespace hairpin {
namespace {

BoundaryEstimatorParams ShippedParams() {
  return LoadBoundaryEstimatorParams(
      Config::Load(HAIRPIN_SOURCE_DIR "/config", "boundary_estimator"));
}

// `count` cones of any colour in a square of 50 m about the car: nothing but phantoms.
std::vector<MapCone> Phantoms(int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-25.0, 25.0);
  std::vector<MapCone> cones;
  for (int i = 0; i < count; ++i) {
    MapCone& cone = cones.emplace_back();
    cone.id = i + 1;
    cone.position = {coordinate(random), coordinate(random)};
    cone.colour = {};
    cone.colour[static_cast<size_t>(i % kNumConeColours)] = 1.0;
    cone.existence = 1.0;
  }
  return cones;
}

std::vector<MapCone> Lane() {
  std::vector<MapCone> cones;
  for (int i = -5; i < 6; ++i) {
    cones.push_back({2 * i + 100, {4.0 * i, 1.6}, {0.05, 0.9, 0.05, 0.0, 0.0}, 1.0});
    cones.push_back({2 * i + 101, {4.0 * i + 1.0, -1.6}, {0.05, 0.05, 0.9, 0.0, 0.0}, 1.0});
  }
  return cones;
}

void EstimateOnALane(benchmark::State& state) {
  BoundaryEstimator estimator(ShippedParams());
  const std::vector<MapCone> cones = Lane();
  for (auto _ : state) benchmark::DoNotOptimize(estimator.Estimate({}, cones));
}
BENCHMARK(EstimateOnALane)->Unit(benchmark::kMicrosecond);

void EstimateOnPhantoms(benchmark::State& state) {
  BoundaryEstimator estimator(ShippedParams());
  const std::vector<MapCone> cones = Phantoms(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(estimator.Estimate({}, cones));
}
BENCHMARK(EstimateOnPhantoms)->Arg(60)->Arg(500)->Arg(5000)->Unit(benchmark::kMicrosecond);

void TriangulateCones(benchmark::State& state) {
  std::vector<Eigen::Vector2d> points;
  for (const MapCone& cone : Phantoms(static_cast<int>(state.range(0))))
    points.push_back(cone.position);
  for (auto _ : state) benchmark::DoNotOptimize(Triangulate(points));
}
BENCHMARK(TriangulateCones)->Arg(60)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hairpin
