#include "tools/simulator/lidar/lidar_sensor.hpp"

#include <cmath>
#include <numbers>

#include "tools/simulator/lidar/hash_random.hpp"
#include "tools/simulator/require.hpp"

namespace hairpin {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

double WrapTurn(double angle) { return angle - kTurn * std::floor(angle / kTurn); }

// Least index whose sequence begins at or after `time_ns`.
int64_t FirstIndexFrom(int64_t time_ns, int64_t period_ns) {
  return time_ns <= 0 ? 0 : (time_ns + period_ns - 1) / period_ns;
}

}  // namespace

Eigen::Isometry3d BodyMotion::At(int64_t time_ns) const {
  const double share =
      static_cast<double>(time_ns - from_ns) / static_cast<double>(to_ns - from_ns);
  const Eigen::Quaterniond from(T_map_from.rotation());
  const Eigen::Quaterniond to(T_map_to.rotation());
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(T_map_from.translation() +
              share * (T_map_to.translation() - T_map_from.translation()));
  T.rotate(from.slerp(share, to));
  return T;
}

LidarSensor::LidarSensor(const LidarSensorParams& params, const Eigen::Isometry3d& T_base_sensor,
                         const OwnBody& body, uint64_t seed)
    : params_(params),
      T_base_sensor_(T_base_sensor),
      seed_(seed),
      own_body_(body, params.model, T_base_sensor) {
  RequireWithin("rotation_hz", params.rotation_hz, 1.0, 30.0);
  RequireWithin("max_range", params.beam.max_range_m, 1.0, 262.0);
  RequirePositive("reference_range", params.beam.reference_range_m);
  RequirePositive("reference_reflectivity", params.beam.reference_reflectivity);
  for (size_t channel = 0; channel < params.model.lasers.size(); ++channel)
    laser_bias_.push_back(params.beam.laser_bias_m * HashRandom(seed, ~channel).Gaussian());
}

double LidarSensor::HeadAzimuth(int64_t time_ns) const {
  const double turns = params_.rotation_hz * 1e-9 * static_cast<double>(time_ns);
  return WrapTurn(params_.start_azimuth_rad + kTurn * (turns - std::floor(turns)));
}

Eigen::Vector3d LidarSensor::Direction(size_t channel, int64_t time_ns) const {
  const Laser& laser = params_.model.lasers[channel];
  return BeamDirection(laser.elevation, HeadAzimuth(time_ns) + laser.azimuth_offset);
}

std::vector<FiringSequence> LidarSensor::Scan(const LidarScene& scene,
                                              const BodyMotion& motion) const {
  std::vector<FiringSequence> sequences;
  const int64_t period = params_.model.sequence_ns;
  for (int64_t index = FirstIndexFrom(motion.from_ns, period);
       index < FirstIndexFrom(motion.to_ns, period); ++index) {
    sequences.push_back(Fire(scene, motion, index));
  }
  return sequences;
}

FiringSequence LidarSensor::Fire(const LidarScene& scene, const BodyMotion& motion,
                                 int64_t index) const {
  FiringSequence sequence;
  sequence.start_ns = index * params_.model.sequence_ns;
  sequence.azimuth_rad = HeadAzimuth(sequence.start_ns);
  sequence.returns.resize(params_.model.lasers.size());
  // Within 50 us the car moves a millimetre: one pose for the sequence, an azimuth for each laser.
  const Eigen::Isometry3f T_map_sensor =
      (motion.At(sequence.start_ns) * T_base_sensor_).cast<float>();
  HashRandom random(seed_, static_cast<uint64_t>(index));
  for (size_t channel = 0; channel < sequence.returns.size(); ++channel) {
    const int64_t time = sequence.start_ns + params_.model.lasers[channel].firing_ns;
    sequence.returns[channel] = FireLaser(scene, T_map_sensor, channel, time, random);
  }
  return sequence;
}

LidarReturn LidarSensor::FireLaser(const LidarScene& scene, const Eigen::Isometry3f& T_map_sensor,
                                   size_t channel, int64_t time_ns, HashRandom& random) const {
  const Laser& laser = params_.model.lasers[channel];
  const double azimuth = HeadAzimuth(time_ns) + laser.azimuth_offset;
  const OwnBody::Echo& body = own_body_.At(channel, azimuth);
  BeamTargets targets;
  if (std::isfinite(body.range)) {
    targets.fill({body.range, body.echo, -1});
  } else {
    const auto sin = static_cast<float>(std::sin(azimuth));
    const auto cos = static_cast<float>(std::cos(azimuth));
    const Eigen::Vector3f forward = BeamDirection(laser.elevation, azimuth).cast<float>();
    const Eigen::Vector3f across(-sin, -cos, 0.0f);
    const Eigen::Matrix3f rotation = T_map_sensor.linear();
    const BeamDirections directions = SpreadBeam(
        params_.beam, rotation * forward, rotation * across, rotation * forward.cross(across));
    targets = scene.Cast(T_map_sensor.translation(), directions,
                         static_cast<float>(params_.beam.max_range_m));
  }
  return StrongestReturn(params_.beam, targets, laser_bias_[channel], random);
}

}  // namespace hairpin
