#include "tools/simulator/lidar/beam.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/simulator/lidar/hash_random.hpp"

namespace hairpin {
namespace {

struct Ray {
  float across;  // of the beam's half angle
  float up;
  float share;
};

// An inner and an outer ring, lighter outside, as a beam of Gaussian profile has it.
constexpr float kInner = 0.3f;
constexpr float kOuter = 0.85f;
constexpr Ray kRays[kRaysPerBeam] = {{kInner, kInner, 0.17f},  {-kInner, kInner, 0.17f},
                                     {kInner, -kInner, 0.17f}, {-kInner, -kInner, 0.17f},
                                     {kOuter, 0.0f, 0.08f},    {-kOuter, 0.0f, 0.08f},
                                     {0.0f, kOuter, 0.08f},    {0.0f, -kOuter, 0.08f}};

constexpr float kMaxGain = 100.0f;  // of retro-reflectors, end of the byte's scale

struct EchoSum {
  float energy = 0.0f;  // share of light * reflectivity / range^2
  float range = 0.0f;   // weighted by energy
  float reflectivity = 0.0f;
  int cone = -1;
  float cone_share = 0.0f;
};

EchoSum SumEcho(const BeamTargets& targets, const std::array<size_t, kRaysPerBeam>& order,
                size_t first, size_t end) {
  EchoSum sum;
  for (size_t i = first; i < end; ++i) {
    const Target& target = targets[order[i]];
    const float received = RayShare(order[i]) * target.echo;
    const float energy = received / (target.range * target.range);
    sum.energy += energy;
    sum.range += energy * target.range;
    sum.reflectivity += received;
    if (target.cone >= 0 && received > sum.cone_share) {
      sum.cone = target.cone;
      sum.cone_share = received;
    }
  }
  sum.range /= std::max(sum.energy, 1e-20f);
  return sum;
}

}  // namespace

float RayShare(size_t ray) { return kRays[ray].share; }

BeamDirections SpreadBeam(const BeamParams& params, const Eigen::Vector3f& direction,
                          const Eigen::Vector3f& across, const Eigen::Vector3f& up) {
  const auto half_across = static_cast<float>(0.5 * params.horizontal_divergence_rad);
  const auto half_up = static_cast<float>(0.5 * params.vertical_divergence_rad);
  BeamDirections directions;
  // Milliradians: the length stays 1 within 1e-6.
  for (size_t i = 0; i < kRaysPerBeam; ++i) {
    directions[i] = direction + half_across * kRays[i].across * across + half_up * kRays[i].up * up;
  }
  return directions;
}

LidarReturn StrongestReturn(const BeamParams& params, const BeamTargets& targets, double laser_bias,
                            HashRandom& random) {
  std::array<size_t, kRaysPerBeam> order;
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return targets[a].range < targets[b].range || (targets[a].range == targets[b].range && a < b);
  });
  EchoSum strongest;
  for (size_t first = 0; first < kRaysPerBeam && std::isfinite(targets[order[first]].range);) {
    const float limit = targets[order[first]].range + static_cast<float>(params.range_resolution_m);
    size_t end = first + 1;
    while (end < kRaysPerBeam && targets[order[end]].range <= limit) ++end;
    const EchoSum echo = SumEcho(targets, order, first, end);
    if (echo.energy > strongest.energy) strongest = echo;
    first = end;
  }
  // All draws are made whatever comes of them, so that one beam's noise depends on nothing else.
  const double chance = random.Uniform();
  const double range_noise = params.range_noise_m * random.Gaussian();
  const double reflectivity_noise = params.reflectivity_noise * random.Gaussian();
  const double reference =
      params.reference_reflectivity / (params.reference_range_m * params.reference_range_m);
  // Half the weakest echoes of reference strength are seen, none below half of it, all above twice.
  const double seen = 0.5 + 0.5 * std::log2(std::max(strongest.energy / reference, 1e-6));
  if (chance >= std::min(seen, 1.0) * (1.0 - params.loss)) return {};
  const double range = strongest.range + laser_bias + range_noise;
  if (range < params.min_range_m || range > params.max_range_m) return {};
  const double reflectivity = strongest.reflectivity * (1.0 + reflectivity_noise);
  return {static_cast<float>(range), static_cast<float>(std::max(reflectivity, 0.0)),
          strongest.cone};
}

uint8_t ReflectivityByte(float reflectivity) {
  if (reflectivity <= 1.0f) return static_cast<uint8_t>(std::lround(100.0f * reflectivity));
  const float share = std::min(std::log(reflectivity) / std::log(kMaxGain), 1.0f);
  return static_cast<uint8_t>(101 + std::lround(154.0f * share));
}

}  // namespace hairpin
