#include <benchmark/benchmark.h>

#include "common/channels.hpp"
#include "daemons/local_mapper/local_mapper_node.hpp"
#include "tests/support/lane_world.hpp"

namespace hairpin {
namespace {

/// One second of car: 100 VELOCITY, 50 PIPELINE_STATUS and the cone sets of a drive along a lane
/// through the node on memq://, wire conversion and checks included. Sending, which is the other
/// daemons' work, is in the figure too.
void LocalMapperNodePerSimulatedSecond(benchmark::State& state) {
  const auto mode = static_cast<int32_t>(state.range(0));
  const LocalMapperParams params =
      LoadLocalMapperParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "local_mapper"));
  constexpr Channel<cones_t> kCones[] = {channels::kConesFusion, channels::kConesLidar,
                                         channels::kConesCamera};
  int64_t maps = 0;
  int64_t cones = 0;
  double seconds = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    test::LaneWorld world({.seed = 3});
    Transport transport("memq://");
    Bus mapper_bus(transport, "local_mapper", 2);
    Bus sensors(transport, "sensors", 1);
    LocalMapperNode node(params, mapper_bus);
    sensors.Subscribe(channels::kLocalMap, [&](const local_map_t& map) {
      ++maps;
      cones += map.num_cones;
    });
    state.ResumeTiming();
    for (int tick = 0;; ++tick) {
      state.PauseTiming();
      const bool more = world.Step();
      const auto scans = world.TakeScans();
      state.ResumeTiming();
      if (!more) break;
      if (tick % 2 == 0) {
        pipeline_status_t status{};
        status.utime = world.utime();
        status.map_mode = mode;
        sensors.Publish(channels::kPipelineStatus, status);
      }
      velocity_t velocity{};
      velocity.utime = world.utime();
      velocity.valid = true;
      velocity.vx_mps = world.velocity().vx;
      velocity.yaw_rate_radps = world.velocity().yaw_rate;
      sensors.Publish(channels::kVelocity, velocity);
      for (const auto& scan : scans)
        sensors.Publish(kCones[static_cast<size_t>(scan.pipeline)], scan.message);
      transport.Drain();
      seconds += 0.01;
    }
  }
  state.counters["maps_per_s"] = static_cast<double>(maps) / seconds;
  state.counters["cones_per_map"] = static_cast<double>(cones) / static_cast<double>(maps);
  state.counters["cost_per_simulated_s"] =
      benchmark::Counter(seconds, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(LocalMapperNodePerSimulatedSecond)
    ->Arg(pipeline_status_t::MODE_FUSION)
    ->Arg(pipeline_status_t::MODE_LIDAR_AND_CAMERA)
    ->Unit(benchmark::kMillisecond);

/// The filter alone: 100 cones in the map, 25 observed.
void LocalMapUpdate(benchmark::State& state) {
  const LocalMapperParams params =
      LoadLocalMapperParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "local_mapper"));
  LocalMap map(params.map);
  ObservationSet set{0, Pipeline::kFusion, {{-1.75, 1.75, 22.0}}, {}};
  const auto add = [&set](int i, double sign) {
    ConeObservation cone;
    cone.position = {sign * (2.0 + 2.5 * (i / 4)), 2.0 * (i % 4) - 3.0};
    cone.covariance = 0.01 * Eigen::Matrix2d::Identity();
    set.cones.push_back(cone);
  };
  for (int i = 0; i < 75; ++i) add(i, -1.0);  // behind, out of view
  set.utime = 1;
  map.Update(set, {}, {});
  set.cones.clear();
  for (int i = 0; i < 25; ++i) add(i, 1.0);
  for (auto _ : state) {
    ++set.utime;
    map.Update(set, {}, {});
  }
  state.counters["cones"] = static_cast<double>(map.Cones().size());
}
BENCHMARK(LocalMapUpdate)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hairpin
