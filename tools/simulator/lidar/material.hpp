#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace hairpin {

/// What a beam can meet.
enum class Material {
  kAsphalt,
  kGrass,
  kKerb,
  kPlasticBarrier,
  kMetal,
  kRubber,
  kCloth,
  kSignFace,
  kCarBody,
  kBluePlastic,
  kYellowPlastic,
  kOrangePlastic,
  kWhiteStripe,
  kBlackStripe
};
inline constexpr int kNumMaterials = 14;

/// How a surface sends back the sensor's light (905 nm).
struct Surface {
  double reflectivity = 0.0;  // share of a white diffuse target's echo; above 1: retro-reflector
  double roughness = 0.0;     // 0: Lambertian, echo falls with the cosine; 1: it does not fall
};

using Materials = std::array<Surface, kNumMaterials>;

inline const Surface& SurfaceOf(const Materials& materials, Material material) {
  return materials[static_cast<size_t>(material)];
}

/// Echo of a surface that is met at the given cosine of incidence, as a share of what a white
/// diffuse target facing the sensor sends back. Rough surfaces lose less: reflectivity *
/// cosine^(1 - roughness).
inline float Echo(const Surface& surface, float cosine) {
  return static_cast<float>(surface.reflectivity) *
         std::pow(cosine, 1.0f - static_cast<float>(surface.roughness));
}

}  // namespace hairpin
