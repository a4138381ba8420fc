#include "tools/simulator/lidar/lidar_rig.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/simulator/require.hpp"

namespace hairpin {

LidarRig::LidarRig(const LidarRigParams& params, const Car& car, const Track& track, uint64_t seed,
                   int64_t epoch_us, Sink sink)
    : params_(params),
      car_(car),
      scene_(params.world, track, seed),
      epoch_us_(epoch_us),
      sink_(std::move(sink)) {
  RequireWithin("position_packet_hz", params.position_packet_hz, 0.1, 100.0);
  const OwnBody body(car, SurfaceOf(params.world.materials, Material::kCarBody));
  const auto add = [&](const std::string& name, const LidarMount& mount, double start_azimuth,
                       uint64_t stream) {
    LidarSensorParams sensor = params.sensor;
    sensor.start_azimuth_rad = start_azimuth;
    units_.push_back({name, LidarSensor(sensor, mount.Transform(), body, 2 * seed + stream),
                      VelodyneEncoder(epoch_us)});
  };
  add("lidar_front", car.lidar_front, params.front_start_azimuth_rad, 0);
  add("lidar_top", car.lidar_top, params.top_start_azimuth_rad, 1);
}

const std::vector<std::string>& LidarRig::Sources() {
  static const std::vector<std::string> kSources{"lidar_front", "lidar_top"};
  return kSources;
}

void LidarRig::SetSource(const std::string& sensor, bool on) {
  const auto unit = std::find_if(units_.begin(), units_.end(),
                                 [&](const Unit& candidate) { return candidate.name == sensor; });
  if (unit == units_.end()) throw std::invalid_argument("no LiDAR " + sensor);
  unit->on = on;
}

void LidarRig::Advance(int64_t utime, const VehicleState& state,
                       const std::vector<TrackCone>& standing) {
  scene_.SetStanding(standing);
  const Eigen::Isometry3d pose = RidePose(params_.ride, car_, scene_.terrain(), state);
  if (last_utime_) {
    if (utime <= *last_utime_) throw std::invalid_argument("LidarRig: time does not increase");
    const BodyMotion motion{1000 * (*last_utime_ - epoch_us_), 1000 * (utime - epoch_us_), pose_,
                            pose};
    for (Unit& unit : units_) {
      for (const FiringSequence& sequence : unit.sensor.Scan(scene_, motion)) {
        if (listener_) listener_(unit.name, sequence);
        const std::optional<VelodyneDataPacket> packet = unit.encoder.Add(sequence);
        if (packet && unit.on) sink_(unit.name, Port::kData, *packet);
      }
    }
  }
  SendPosition(utime);
  last_utime_ = utime;
  pose_ = pose;
}

void LidarRig::SendPosition(int64_t utime) {
  if (utime < next_position_utime_) return;
  next_position_utime_ = utime + std::llround(1e6 / params_.position_packet_hz);
  const VelodynePositionPacket packet = EncodeVelodynePosition(utime);
  for (const Unit& unit : units_) {
    if (unit.on) sink_(unit.name, Port::kPosition, packet);
  }
}

}  // namespace hairpin
