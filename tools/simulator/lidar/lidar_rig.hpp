#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/car.hpp"
#include "tools/simulator/lidar/lidar_sensor.hpp"
#include "tools/simulator/lidar/ride.hpp"
#include "tools/simulator/lidar/velodyne_encoder.hpp"

namespace hairpin {

struct LidarRigParams {
  WorldParams world;
  RideParams ride;
  LidarSensorParams sensor;  // both are alike, but for their start azimuth
  double front_start_azimuth_rad = 0.0;
  double top_start_azimuth_rad = 0.0;
  double position_packet_hz = 0.0;
};

/// Both LiDARs of the car, down to their UDP packets.
class LidarRig {
 public:
  enum class Port { kData, kPosition };
  /// Takes each packet at the time at which the sensor would send it. `sensor`: "lidar_front" or
  /// "lidar_top".
  using Sink =
      std::function<void(const std::string& sensor, Port port, std::span<const uint8_t> packet)>;

  /// `epoch_us`: time of the car's first pose, since the Unix epoch.
  LidarRig(const LidarRigParams& params, const Car& car, const Track& track, uint64_t seed,
           int64_t epoch_us, Sink sink);

  /// Names that SetSource() knows.
  static const std::vector<std::string>& Sources();
  /// Cuts a sensor's cable, or plugs it in again. Throws std::invalid_argument for another name.
  void SetSource(const std::string& sensor, bool on);

  /// The car has moved on to `state` at `utime`, later than the last: casts what was fired
  /// meanwhile. `standing`: the cones that are left, in the track's order.
  void Advance(int64_t utime, const VehicleState& state, const std::vector<TrackCone>& standing);

  const LidarScene& scene() const { return scene_; }
  /// T_map_base in space, at the last Advance().
  const Eigen::Isometry3d& pose() const { return pose_; }
  /// Called with each sequence cast, before its packet is sent.
  void OnSequence(std::function<void(const std::string& sensor, const FiringSequence&)> listener) {
    listener_ = std::move(listener);
  }

 private:
  struct Unit {
    std::string name;
    LidarSensor sensor;
    VelodyneEncoder encoder;
    bool on = true;
  };
  void SendPosition(int64_t utime);

  LidarRigParams params_;
  Car car_;
  LidarScene scene_;
  int64_t epoch_us_;
  Sink sink_;
  std::vector<Unit> units_;
  std::function<void(const std::string&, const FiringSequence&)> listener_;
  std::optional<int64_t> last_utime_;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  int64_t next_position_utime_ = 0;
};

}  // namespace hairpin
