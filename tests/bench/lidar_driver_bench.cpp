// The packets of a 57,600-point scan to revolutions and to the message, and back.

#include <benchmark/benchmark.h>

#include "tests/support/lidar_setup.hpp"
#include "tests/support/velodyne_packets.hpp"

namespace hairpin {
namespace {

constexpr int kPackets = 150;  // of 384 returns

void DecodeAndPack(benchmark::State& state) {
  LidarDriver driver = MakeDriver(Vlp32c());
  VelodyneSource source;
  source.block_turn = 20.0;
  size_t points = 0;
  for (auto _ : state) {
    state.PauseTiming();
    std::vector<Bytes> turn;
    for (int i = 0; i < kPackets; ++i) turn.push_back(source.Next());
    state.ResumeTiming();
    for (const Bytes& packet : turn) {
      const auto result = driver.Add({packet, 1'700'000'000'000'000, {}});
      if (!result.revolution) continue;
      lidar_scan_t message{};
      message.coordinate_step_m = 0.004;
      message.time_step_s = 4e-6;
      PackPoints(result.revolution->points, message);
      points = result.revolution->points.size();
      benchmark::DoNotOptimize(message.points.data());
    }
  }
  state.counters["points"] = static_cast<double>(points);
}
BENCHMARK(DecodeAndPack)->Unit(benchmark::kMillisecond);

void Unpack(benchmark::State& state) {
  lidar_scan_t message{};
  message.coordinate_step_m = 0.004;
  message.time_step_s = 4e-6;
  message.ring_elevation_rad = {0.0f};
  PackPoints(std::vector<LidarPoint>(57'600, LidarPoint{{1.0f, 2.0f, 3.0f}, 9, 0, 0.05f}), message);
  std::vector<LidarPoint> points;
  for (auto _ : state) {
    if (!UnpackPoints(message, points).empty()) state.SkipWithError("does not unpack");
    benchmark::DoNotOptimize(points.data());
  }
}
BENCHMARK(Unpack)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hairpin
