#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/bus.hpp"
#include "common/config.hpp"
#include "daemons/lidar_driver/clock_monitor.hpp"
#include "daemons/lidar_driver/lidar_driver.hpp"
#include "daemons/lidar_driver/velodyne_decoder.hpp"

namespace hairpin {

struct LidarDriverNodeParams {
  LidarDriverParams driver;
  VelodyneParams sensor;
  double coordinate_step = 0.0;     // of the message [m]
  double clock_window_s = 0.0;      // over which the clocks are compared
  double warn_clock_error_s = 0.0;  // said so on stderr
  double max_clock_error_s = 0.0;   // nothing is published
  uint16_t data_port = 0;
  uint16_t position_port = 0;
  int receive_buffer_bytes = 0;
};

/// "front" and "top": one driver runs for each LiDAR of the car.
std::vector<std::string> LidarInstances();

/// Reads `lidar_driver.yaml`, with the calibration file it names: what all have in common, and the
/// instance's own section.
LidarDriverNodeParams LoadLidarDriverParams(const Config& config, const std::string& instance);

/// Publishes a message per revolution on LIDAR_FRONT or LIDAR_TOP. Compares the sensor's clock with
/// that of IMU. In its heartbeats, what it was sent stands as the channel "packets": `undecodable`
/// are those of a wrong size, model, mode, flag, azimuth or time, `duplicates` those that do not
/// advance, `refused` those of a foreign sender; `implausible_time` counts revolutions not
/// published for the sensor's clock, and `missing` what the kernel dropped.
class LidarDriverNode {
 public:
  /// Throws std::invalid_argument for an unknown instance, and as VelodyneDecoder and LidarDriver
  /// do. `bus` must outlive the node.
  LidarDriverNode(const LidarDriverNodeParams& params, const std::string& instance, Bus& bus);
  LidarDriverNode(const LidarDriverNode&) = delete;
  LidarDriverNode& operator=(const LidarDriverNode&) = delete;

  /// A data or position packet from the wire.
  void OnPacket(const LidarPacket& packet);
  void OnOverflows(int64_t packets) { health_.missing = packets; }

  const LidarDriver& driver() const { return driver_; }

 private:
  void OnImu(int64_t utime);
  void CountRefused(const Refused& refused);
  void Publish(const Revolution& revolution);

  LidarDriverNodeParams params_;
  Bus& bus_;
  const Channel<lidar_scan_t>& channel_;
  channel_health_t& health_;
  LidarDriver driver_;
  ClockMonitor clock_monitor_;
};

}  // namespace hairpin
