#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <string_view>

namespace hairpin {

/// A stream of random numbers, the same on every platform: the engine is fixed by the C++ standard,
/// the distributions, which are not, are written here. Streams of different names are independent
/// of one another.
class RandomStream {
 public:
  RandomStream(uint64_t seed, std::string_view name);
  /// The one without a name.
  explicit RandomStream(uint64_t seed);

  /// Uniform in [0, 1).
  double Uniform();
  /// Uniform in [min, max).
  double Uniform(double min, double max) { return min + (max - min) * Uniform(); }
  /// In 0 .. count - 1; count > 0.
  size_t Index(size_t count) { return static_cast<size_t>(Uniform() * static_cast<double>(count)); }
  /// Normal with mean 0; draws also where sigma is 0.
  double Gaussian(double sigma);
  /// True with `probability`.
  bool Chance(double probability) { return Uniform() < probability; }

 private:
  std::mt19937_64 engine_;
  std::optional<double> spare_;  // of the last pair of normal numbers
};

/// A bias that wanders: first-order Gauss-Markov process of stationary `sigma`, drawn from it at
/// the start.
class WanderingBias {
 public:
  /// Throws std::invalid_argument unless sigma >= 0 and correlation_time > 0 [s].
  WanderingBias(double sigma, double correlation_time, RandomStream& random);
  /// The bias `duration` [s] later.
  double Step(double duration, RandomStream& random);

 private:
  double sigma_;
  double correlation_time_;
  double value_;
};

}  // namespace hairpin
