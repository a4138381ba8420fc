#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace hairpin {

/// Random numbers that belong to a place (a seed and an index) and not to the order of asking:
/// SplitMix64 from a mixture of both. For noise that must not depend on what else was computed.
class HashRandom {
 public:
  HashRandom(uint64_t seed, uint64_t index) : state_(Mix(seed + kGolden) ^ Mix(~index)) {}

  /// Uniform in [0, 1).
  double Uniform() {
    state_ += kGolden;
    return static_cast<double>(Mix(state_) >> 11) * 0x1.0p-53;
  }
  /// Normal with mean 0 and sigma 1.
  double Gaussian() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * Uniform());
  }

 private:
  static constexpr uint64_t kGolden = 0x9e3779b97f4a7c15u;
  static uint64_t Mix(uint64_t value) {
    value = (value ^ value >> 30) * 0xbf58476d1ce4e5b9u;
    value = (value ^ value >> 27) * 0x94d049bb133111ebu;
    return value ^ value >> 31;
  }
  uint64_t state_;
};

}  // namespace hairpin
