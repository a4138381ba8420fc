#include "tools/simulator/lidar/clutter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tools/simulator/lidar/terrain.hpp"
#include "tools/simulator/require.hpp"
#include "tools/simulator/track_geometry.hpp"

namespace hairpin {
namespace {

constexpr double kPi = std::numbers::pi;

/// Where something is to stand: on the ground, `yaw` along the track.
struct Site {
  Eigen::Vector3d position;
  double yaw;
};

Eigen::Isometry3d At(const Site& site, double along, double across, double up) {
  return Upright(site.position, site.yaw) * Eigen::Translation3d(along, across, up);
}

void AddBarrier(const Site& site, RandomStream& random, std::vector<Thing>& things) {
  const double height = random.Uniform(0.8, 1.1);
  const double length = random.Uniform(2.0, 6.0);
  const bool metal = random.Chance(0.5);
  Thing barrier{{}, metal ? Material::kMetal : Material::kPlasticBarrier};
  if (metal) {  // two rails on posts
    for (const double z : {0.45, height - 0.1})
      AddBox(At(site, 0.0, 0.0, z), {length, 0.05, 0.25}, barrier.mesh);
    for (const double x : {-0.45, 0.0, 0.45})
      AddFrustum(At(site, x * length, 0.0, 0.0), 0.04, 0.04, height, 8, barrier.mesh);
  } else {
    AddBox(At(site, 0.0, 0.0, 0.5 * height), {length, 0.4, height}, barrier.mesh);
  }
  things.push_back(std::move(barrier));
}

void AddPerson(const Site& site, RandomStream& random, std::vector<Thing>& things) {
  const double size = random.Uniform(1.6, 1.95);
  const double stride = random.Uniform(0.1, 0.35);
  Thing legs{{}, Material::kCloth};
  AddFrustum(At(site, 0.5 * stride, 0.09, 0.0), 0.06, 0.09, 0.47 * size, 10, legs.mesh);
  AddFrustum(At(site, -0.5 * stride, -0.09, 0.0), 0.06, 0.09, 0.47 * size, 10, legs.mesh);
  AddFrustum(At(site, 0.0, 0.0, 0.87 * size), 0.1, 0.08, 0.13 * size, 10, legs.mesh);
  things.push_back(std::move(legs));
  // A marshal wears a vest with reflecting stripes.
  const bool marshal = random.Chance(0.3);
  Thing trunk{{}, Material::kCloth};
  AddFrustum(At(site, 0.0, 0.0, 0.47 * size), 0.17, 0.22, 0.36 * size, 12, trunk.mesh);
  things.push_back(std::move(trunk));
  if (!marshal) return;
  Thing stripe{{}, Material::kSignFace};
  AddFrustum(At(site, 0.0, 0.0, 0.62 * size), 0.215, 0.225, 0.05, 12, stripe.mesh);
  things.push_back(std::move(stripe));
}

void AddTyres(const Site& site, RandomStream& random, std::vector<Thing>& things) {
  const int columns = 1 + static_cast<int>(random.Uniform(0.0, 4.0));
  const double height = 0.2 * (2.0 + std::floor(random.Uniform(0.0, 4.0)));
  Thing stack{{}, Material::kRubber};
  for (int i = 0; i < columns; ++i)
    AddFrustum(At(site, 0.62 * i, 0.0, 0.0), 0.3, 0.3, height, 16, stack.mesh);
  things.push_back(std::move(stack));
}

void AddSign(const Site& site, RandomStream& random, std::vector<Thing>& things) {
  const double height = random.Uniform(1.2, 2.2);
  Thing post{{}, Material::kMetal};
  AddFrustum(At(site, 0.0, 0.0, 0.0), 0.03, 0.03, height, 8, post.mesh);
  Thing board{{}, Material::kSignFace};
  AddBox(At(site, 0.0, 0.0, height), {0.03, 0.6, 0.5}, board.mesh);
  things.push_back(std::move(post));
  things.push_back(std::move(board));
}

void AddKerb(const Site& site, RandomStream& random, std::vector<Thing>& things) {
  const double height = random.Uniform(0.03, 0.06);
  Thing kerb{{}, Material::kKerb};
  // Sunk into the ground, so that no gap shows where it slopes.
  AddBox(At(site, 0.0, 0.0, 0.5 * height - 0.1), {random.Uniform(1.5, 3.0), 0.35, height + 0.2},
         kerb.mesh);
  things.push_back(std::move(kerb));
}

class Placement {
 public:
  Placement(const ClutterParams& params, const Track& track, const HeightFunction& height,
            uint64_t seed)
      : params_(params), cones_(AllCones(track)), height_(height), random_(seed, "clutter") {}

  /// Things outside of `side`, whose inside is where `other` is.
  void Beside(const std::vector<TrackCone>& side, const std::vector<TrackCone>& other) {
    for (const TrackCone& cone : side) {
      const Eigen::Vector2d inward = NearestCone(other, cone.position) - cone.position;
      const Eigen::Vector2d outward = -inward.normalized();
      MaybePlace(params_.kerb_probability, cone.position + 0.9 * outward, outward, 0.5, AddKerb);
      Place(params_.barrier_probability, cone.position, outward, AddBarrier);
      Place(params_.person_probability, cone.position, outward, AddPerson);
      Place(params_.tyre_stack_probability, cone.position, outward, AddTyres);
      Place(params_.sign_probability, cone.position, outward, AddSign);
    }
  }

  void Box(const Eigen::Vector2d& position) {
    Thing box{{}, Material::kPlasticBarrier};
    const Site site = SiteAt(position, random_.Uniform(0.0, kPi));
    AddBox(At(site, 0.0, 0.0, 0.15), {0.4, 0.3, 0.3}, box.mesh);
    things_.push_back(std::move(box));
  }

  std::vector<Thing> Take() { return std::move(things_); }

 private:
  using Builder = void (*)(const Site&, RandomStream&, std::vector<Thing>&);

  static Eigen::Vector2d NearestCone(const std::vector<TrackCone>& cones,
                                     const Eigen::Vector2d& position) {
    const auto nearest =
        std::min_element(cones.begin(), cones.end(), [&](const TrackCone& a, const TrackCone& b) {
          return (a.position - position).norm() < (b.position - position).norm();
        });
    return nearest->position;
  }

  Site SiteAt(const Eigen::Vector2d& position, double yaw) const {
    return {{position.x(), position.y(), height_(position.x(), position.y())}, yaw};
  }

  void Place(double probability, const Eigen::Vector2d& cone, const Eigen::Vector2d& outward,
             Builder builder) {
    const double distance = random_.Uniform(params_.min_distance_m, params_.max_distance_m);
    MaybePlace(probability, cone + distance * outward, outward, params_.min_distance_m, builder);
  }

  void MaybePlace(double probability, const Eigen::Vector2d& position,
                  const Eigen::Vector2d& outward, double clearance, Builder builder) {
    if (!random_.Chance(probability)) return;
    if ((NearestCone(cones_, position) - position).norm() < clearance) return;
    builder(SiteAt(position, std::atan2(outward.y(), outward.x()) + 0.5 * kPi), random_, things_);
  }

  ClutterParams params_;
  std::vector<TrackCone> cones_;
  const HeightFunction& height_;
  RandomStream random_;
  std::vector<Thing> things_;
};

}  // namespace

std::vector<Thing> PlaceClutter(const ClutterParams& params, const Track& track,
                                const HeightFunction& height, uint64_t seed) {
  RequireWithin("min_distance", params.min_distance_m, 0.5, 50.0);
  RequireWithin("max_distance", params.max_distance_m, params.min_distance_m, 100.0);
  Placement placement(params, track, height, seed);
  placement.Beside(track.left, track.right);
  placement.Beside(track.right, track.left);
  for (const Eigen::Vector2d& position : track.clutter) placement.Box(position);
  return placement.Take();
}

}  // namespace hairpin
