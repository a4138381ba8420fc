#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace hairpin {

/// Random numbers that are the same on every machine: the standard fixes the engine's bits, but not
/// what its distributions make of them.
class TrackRandom {
 public:
  explicit TrackRandom(uint64_t seed) : engine_(seed) {}

  /// In [low, high).
  double Uniform(double low, double high) {
    constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
    return low + (high - low) * static_cast<double>(engine_() >> 11) * kUnit;
  }
  /// In 0 .. count - 1; count > 0.
  size_t Index(size_t count) {
    return static_cast<size_t>(Uniform(0.0, 1.0) * static_cast<double>(count));
  }
  bool Chance(double probability) { return Uniform(0.0, 1.0) < probability; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace hairpin
