#include <benchmark/benchmark.h>

#include <vector>

#include "common/wire_schema.hpp"
#include "hairpin/local_map_t.hpp"

namespace hairpin {
namespace {

// What every node pays for a message before it is decoded: a local map of 100 cones.
void CheckLocalMap(benchmark::State& state) {
  local_map_t message{};
  message.cones.resize(100);
  message.num_cones = 100;
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  const WireSchema& schema = WireSchema::Hairpin();
  constexpr size_t kFingerprint = 8;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        schema.Problem("local_map_t", bytes.data() + kFingerprint, bytes.size() - kFingerprint));
  }
  state.SetBytesProcessed(state.iterations() * static_cast<int64_t>(bytes.size()));
}
BENCHMARK(CheckLocalMap);

}  // namespace
}  // namespace hairpin
