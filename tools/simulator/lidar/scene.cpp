#include "tools/simulator/lidar/scene.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulator/lidar/cone_shape.hpp"
#include "tools/simulator/lidar/hash_random.hpp"
#include "tools/simulator/require.hpp"
#include "tools/simulator/track_geometry.hpp"

namespace hairpin {
namespace {

constexpr uint32_t kGround = 0;         // number of the ground's mesh
constexpr float kBladeCell = 0.03f;     // m: grass has a height of its own in each
constexpr float kMaxGrassShift = 0.5f;  // m along the ray

// Height of the grass at a point, as a share of its full height; the same whoever looks.
float BladeHeight(const Eigen::Vector3f& point) {
  const auto cell = [](float value) {
    return static_cast<uint64_t>(static_cast<int64_t>(std::floor(value / kBladeCell)));
  };
  return static_cast<float>(HashRandom(cell(point.x()), cell(point.y())).Uniform());
}

}  // namespace

LidarScene::LidarScene(const WorldParams& params, const Track& track, uint64_t seed)
    : params_(params), cones_(AllCones(track)), terrain_(params.terrain, cones_, seed) {
  RequireWithin("cone_reflectivity_spread", params.cone_reflectivity_spread, 0.0, 0.5);
  RandomStream random(seed, "lidar_cones");
  rays_.Add(terrain_.mesh());
  for (const TrackCone& cone : cones_) {
    const double foot = terrain_.Height(cone.position.x(), cone.position.y());
    const Eigen::Vector3d position(cone.position.x(), cone.position.y(), foot);
    rays_.Add(ConeMesh(cone.colour, Upright(position, random.Uniform(0.0, 1.6))));
    cone_foot_.push_back(foot);
    const double factor = 1.0 + random.Gaussian(params.cone_reflectivity_spread);
    cone_factor_.push_back(static_cast<float>(std::clamp(factor, 0.3, 1.7)));
  }
  standing_.assign(cones_.size(), true);
  const HeightFunction height = [this](double x, double y) { return terrain_.Height(x, y); };
  for (const Thing& thing : PlaceClutter(params.clutter, track, height, seed)) {
    rays_.Add(thing.mesh);
    thing_material_.push_back(thing.material);
  }
  rays_.Commit();
}

void LidarScene::SetStanding(const std::vector<TrackCone>& standing) {
  const auto count = std::count(standing_.begin(), standing_.end(), true);
  if (static_cast<size_t>(count) == standing.size()) return;
  auto next = standing.begin();
  for (size_t i = 0; i < cones_.size(); ++i) {
    const bool stands = next != standing.end() && next->position == cones_[i].position;
    if (stands) ++next;
    if (stands == standing_[i]) continue;
    standing_[i] = stands;
    rays_.Enable(static_cast<uint32_t>(i) + 1, stands);
  }
  rays_.Commit();
}

BeamTargets LidarScene::Cast(const Eigen::Vector3f& origin, const BeamDirections& directions,
                             float max_range) const {
  const BeamHits hits = rays_.Cast(origin, directions, max_range);
  BeamTargets targets;
  for (size_t i = 0; i < kRaysPerBeam; ++i) {
    const RayHit& hit = hits[i];
    if (!std::isfinite(hit.range)) continue;
    const Eigen::Vector3f point = origin + hit.range * directions[i];
    if (hit.mesh == kGround) {
      targets[i] = GroundTarget(hit, point, directions[i]);
    } else if (hit.mesh <= cones_.size()) {
      const size_t cone = hit.mesh - 1;
      targets[i] = ConeTarget(hit, cone, point.z() - cone_foot_[cone]);
    } else {
      targets[i] = ToTarget(hit, thing_material_[hit.mesh - 1 - cones_.size()]);
    }
  }
  return targets;
}

Target LidarScene::GroundTarget(const RayHit& hit, const Eigen::Vector3f& point,
                                const Eigen::Vector3f& direction) const {
  const Material material = terrain_.MaterialAt(point.x(), point.y());
  Target target = ToTarget(hit, material);
  if (material != Material::kGrass) return target;
  // The blades stop a flat ray before the soil does.
  const float height = static_cast<float>(params_.terrain.grass_height_m) * BladeHeight(point);
  const float slope = std::max(-direction.z(), 1e-3f);
  target.range -= std::min({height / slope, kMaxGrassShift, 0.5f * target.range});
  return target;
}

Target LidarScene::ConeTarget(const RayHit& hit, size_t cone, double height) const {
  Target target = ToTarget(hit, ConeMaterialAt(cones_[cone].colour, height));
  target.echo *= cone_factor_[cone];
  target.cone = static_cast<int>(cone);
  return target;
}

Target LidarScene::ToTarget(const RayHit& hit, Material material) const {
  return {hit.range, Echo(SurfaceOf(params_.materials, material), hit.cosine), -1};
}

}  // namespace hairpin
