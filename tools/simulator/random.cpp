#include "tools/simulator/random.hpp"

#include <cmath>
#include <numbers>

#include "tools/simulator/require.hpp"

namespace hairpin {
namespace {

// FNV-1a over the name, mixed with the seed by SplitMix64's finaliser, so that neighbouring seeds
// differ in every bit.
uint64_t MixedSeed(uint64_t seed, std::string_view name) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (const char letter : name) hash = (hash ^ static_cast<uint8_t>(letter)) * 0x100000001b3u;
  uint64_t mixed = hash + seed * 0x9e3779b97f4a7c15u;
  mixed = (mixed ^ mixed >> 30) * 0xbf58476d1ce4e5b9u;
  mixed = (mixed ^ mixed >> 27) * 0x94d049bb133111ebu;
  return mixed ^ mixed >> 31;
}

}  // namespace

RandomStream::RandomStream(uint64_t seed, std::string_view name) : engine_(MixedSeed(seed, name)) {}

RandomStream::RandomStream(uint64_t seed) : engine_(seed) {}

double RandomStream::Uniform() {
  return static_cast<double>(engine_() >> 11) * 0x1.0p-53;  // 53 bits: every double there is exact
}

double RandomStream::Gaussian(double sigma) {
  if (spare_) {
    const double value = *spare_;
    spare_.reset();
    return sigma * value;
  }
  // Box-Muller; 1 - u is in (0, 1], where the logarithm is finite.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
  const double angle = 2.0 * std::numbers::pi * Uniform();
  spare_ = radius * std::sin(angle);
  return sigma * radius * std::cos(angle);
}

WanderingBias::WanderingBias(double sigma, double correlation_time, RandomStream& random)
    : sigma_(sigma), correlation_time_(correlation_time), value_(0.0) {
  RequireNotNegative("bias sigma", sigma);
  RequirePositive("bias correlation_time", correlation_time);
  value_ = random.Gaussian(sigma);
}

double WanderingBias::Step(double duration, RandomStream& random) {
  // Exact discretisation: x' = f x + sqrt(1 - f^2) sigma n keeps the variance for any step.
  const double factor = std::exp(-duration / correlation_time_);
  value_ = factor * value_ + random.Gaussian(sigma_ * std::sqrt(1.0 - factor * factor));
  return value_;
}

}  // namespace hairpin
