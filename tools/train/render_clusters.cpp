#include "tools/train/render_clusters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hairpin {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kCones = 36;
constexpr double kMinGap = 1.0;  // m between cones
constexpr float kReach = 0.25f;  // m about the axis that a detector gathers returns from
constexpr int64_t kRevolutions = 1;

struct Points {
  std::vector<Eigen::Vector3f> position;  // base [m]
  std::vector<uint8_t> intensity;
};

Surface Vary(const Surface& surface, RandomStream& random) {
  return {surface.reflectivity * std::exp(random.Gaussian(0.25)),
          std::clamp(surface.roughness + random.Gaussian(0.15), 0.0, 0.9)};
}

WorldParams VaryWorld(WorldParams world, RandomStream& random) {
  const double gain = std::exp(random.Gaussian(0.15));  // of the sensor's calibration
  for (Surface& surface : world.materials) {
    surface = Vary(surface, random);
    surface.reflectivity *= gain;
  }
  world.terrain.max_slope *= random.Uniform(0.0, 2.0);
  world.terrain.bump_height_m *= random.Uniform(0.0, 2.0);
  world.terrain.margin_m = 20.0;
  world.clutter.min_distance_m = 1.0;
  world.clutter.max_distance_m = 6.0;
  return world;
}

// A sensor of the kind, of another one with even rings, or with twice as many.
LidarSensorParams VarySensor(LidarSensorParams sensor, RandomStream& random) {
  if (random.Chance(0.4)) {
    const int rings = random.Chance(0.5) ? 32 : 64;
    const double step = random.Uniform(0.3, 0.7) * kDegree;
    sensor.model = {"even", {}, 55296};
    for (int64_t ring = 0; ring < rings; ++ring)
      sensor.model.lasers.push_back(
          {(static_cast<double>(ring) - 0.7 * rings) * step, 0.0, 500 * ring});
  }
  sensor.rotation_hz = random.Uniform(7.0, 15.0);
  sensor.beam.horizontal_divergence_rad *= random.Uniform(0.5, 1.3);
  sensor.beam.vertical_divergence_rad *= random.Uniform(0.5, 1.5);
  sensor.beam.range_noise_m *= random.Uniform(0.5, 2.0);
  sensor.beam.reflectivity_noise *= random.Uniform(0.5, 2.5);
  sensor.beam.loss = random.Uniform(0.0, 0.1);
  return sensor;
}

LidarMount VaryMount(LidarMount mount, RandomStream& random) {
  mount.position += Eigen::Vector3d(random.Uniform(0.0, 0.15), random.Uniform(-0.2, 0.2),
                                    random.Uniform(-0.1, 0.3));
  mount.pitch += random.Uniform(-0.03, 0.03);
  mount.roll += random.Uniform(-0.03, 0.03);
  return mount;
}

Track StrewCones(RandomStream& random) {
  Track track;
  std::vector<Eigen::Vector2d> taken;
  for (int attempt = 0; attempt < 40 * kCones && taken.size() < kCones; ++attempt) {
    const double range = random.Uniform(2.0, 18.0);
    const double bearing = random.Uniform(-75.0, 75.0) * kDegree;
    const Eigen::Vector2d place(range * std::cos(bearing), range * std::sin(bearing));
    const bool free = std::all_of(taken.begin(), taken.end(), [&](const Eigen::Vector2d& other) {
      return (other - place).norm() > kMinGap;
    });
    if (!free) continue;
    taken.push_back(place);
    const double kind = random.Uniform();
    if (kind < 0.4) track.left.push_back({place, ConeColour::kBlue});
    if (kind >= 0.4 && kind < 0.8) track.right.push_back({place, ConeColour::kYellow});
    if (kind >= 0.8 && kind < 0.88) track.others.push_back({place, ConeColour::kOrange});
    if (kind >= 0.88 && kind < 0.94) track.others.push_back({place, ConeColour::kOrangeLarge});
    if (kind >= 0.94) track.others.push_back({place, ConeColour::kUnknown});
  }
  if (track.left.empty()) track.left.push_back({{25.0, 5.0}, ConeColour::kBlue});
  if (track.right.empty()) track.right.push_back({{25.0, -5.0}, ConeColour::kYellow});
  return track;
}

void Scan(const LidarSensor& sensor, const Eigen::Isometry3d& T_base_sensor,
          const LidarScene& scene, const Eigen::Isometry3d& T_map_base, Points& points) {
  const auto turn_ns = static_cast<int64_t>(1e9 / sensor.params().rotation_hz);
  const BodyMotion still{0, kRevolutions * turn_ns, T_map_base, T_map_base};
  const auto& lasers = sensor.params().model.lasers;
  for (const FiringSequence& sequence : sensor.Scan(scene, still)) {
    for (size_t channel = 0; channel < lasers.size(); ++channel) {
      const LidarReturn& echo = sequence.returns[channel];
      if (echo.range <= 0.0f) continue;
      const Eigen::Vector3d direction =
          sensor.Direction(channel, sequence.start_ns + lasers[channel].firing_ns);
      points.position.push_back((T_base_sensor * (echo.range * direction)).cast<float>());
      points.intensity.push_back(ReflectivityByte(echo.reflectivity));
    }
  }
}

LabelledCone Gather(const Points& points, const TrackCone& cone, const Eigen::Vector3d& foot,
                    RandomStream& random) {
  LabelledCone sample;
  sample.colour = cone.colour;
  const double axis_error = 0.02 + 0.001 * foot.head<2>().norm();
  sample.returns.axis = {static_cast<float>(foot.x() + random.Gaussian(axis_error)),
                         static_cast<float>(foot.y() + random.Gaussian(axis_error))};
  const auto ground = static_cast<float>(foot.z() + random.Gaussian(0.015));
  const auto lowest = static_cast<float>(random.Uniform(0.01, 0.06));
  for (size_t i = 0; i < points.position.size(); ++i) {
    const Eigen::Vector3f& point = points.position[i];
    const float height = point.z() - ground;
    if ((point.head<2>() - sample.returns.axis).norm() > kReach) continue;
    if (height < lowest || height > 0.6f) continue;
    sample.returns.x.push_back(point.x());
    sample.returns.y.push_back(point.y());
    sample.returns.z.push_back(height);
    sample.returns.age.push_back(0.0f);
    sample.returns.intensity.push_back(points.intensity[i]);
  }
  return sample;
}

}  // namespace

std::vector<LabelledCone> RenderClusters(const LidarRigParams& params, const Car& car,
                                         uint64_t seed) {
  RandomStream random(seed, "render_clusters");
  const WorldParams world = VaryWorld(params.world, random);
  const Track track = StrewCones(random);
  const LidarScene scene(world, track, seed);
  const OwnBody body(car, SurfaceOf(world.materials, Material::kCarBody));
  const Eigen::Isometry3d T_map_base = RidePose(params.ride, car, scene.terrain(), {});
  const LidarSensorParams model = VarySensor(params.sensor, random);
  const double choice = random.Uniform();  // both sensors, or one of them
  Points points;
  const auto scan = [&](const LidarMount& shipped, uint64_t stream) {
    const Eigen::Isometry3d T_base_sensor = VaryMount(shipped, random).Transform();
    Scan(LidarSensor(model, T_base_sensor, body, 2 * seed + stream), T_base_sensor, scene,
         T_map_base, points);
  };
  if (choice < 0.8) scan(car.lidar_front, 0);
  if (choice > 0.2) scan(car.lidar_top, 1);
  std::vector<LabelledCone> samples;
  for (const TrackCone& cone : scene.cones()) {
    const Eigen::Vector3d foot(cone.position.x(), cone.position.y(),
                               scene.terrain().Height(cone.position.x(), cone.position.y()));
    samples.push_back(Gather(points, cone, T_map_base.inverse() * foot, random));
  }
  return samples;
}

}  // namespace hairpin
