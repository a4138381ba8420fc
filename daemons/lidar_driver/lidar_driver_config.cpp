#include <numbers>
#include <stdexcept>

#include "daemons/lidar_driver/lidar_driver_node.hpp"
#include "daemons/lidar_driver/udp_receiver.hpp"

namespace hairpin {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMaxRange = 131.0;  // m: 16 bits of 4 mm

std::vector<double> Radians(std::vector<double> degrees) {
  for (double& angle : degrees) angle *= kDegree;
  return degrees;
}

LidarCalibration LoadCalibration(const Config& file, size_t lasers) {
  return {Radians(file.Numbers("elevation_deg", lasers, {-90.0, 90.0})),
          Radians(file.Numbers("azimuth_offset_deg", lasers, {-10.0, 10.0}))};
}

void LoadSensor(const Config& section, const Config& config, LidarDriverNodeParams& params) {
  params.sensor.model = section.Text("model");
  const VelodyneModel* model = FindVelodyneModel(params.sensor.model);
  if (model == nullptr) {
    std::string known;
    for (const std::string& name : VelodyneModelNames())
      known += (known.empty() ? "" : ", ") + name;
    throw ConfigError("lidar_driver.yaml: model: `" + params.sensor.model + "` is none of " +
                      known);
  }
  params.sensor.calibration =
      LoadCalibration(config.Sibling(section.Text("calibration")), model->firings.size());
  params.sensor.min_range = section.Number("min_range_m", {0.0, 10.0});
  params.sensor.max_range =
      section.Number("max_range_m", {params.sensor.min_range + 1.0, kMaxRange});
  const std::string address = section.Text("sensor_address");
  params.driver.sensor_address = ParseIpv4(address);
  if (!params.driver.sensor_address && address != "any")
    throw ConfigError("lidar_driver.yaml: sensor_address: `" + address +
                      "` is neither an IPv4 address nor any");
  params.data_port = static_cast<uint16_t>(section.Integer("data_port", 1, 65535));
  params.position_port = static_cast<uint16_t>(section.Integer("position_port", 1, 65535));
  params.driver.revolution.cut_azimuth = section.Number("cut_azimuth_deg", {0.0, 360.0}) * kDegree;
}

}  // namespace

LidarDriverNodeParams LoadLidarDriverParams(const Config& config, const std::string& instance) {
  LidarDriverNodeParams params;
  // Every instance checks the whole file; its own section comes last and stays.
  for (const std::string& other : LidarInstances())
    if (other != instance) LoadSensor(config.Section(other), config, params);
  LoadSensor(config.Section(instance), config, params);
  params.coordinate_step = config.Number("coordinate_step_m", {0.004, 0.02});
  params.driver.revolution.max_refused_share = config.Number("max_refused_share", {0.0, 1.0});
  params.driver.clock.gnss_wait_s = config.Number("gnss_wait_s", {0.0, 60.0});
  params.driver.clock.gnss_hold_s = config.Number("gnss_hold_s", {1.0, 600.0});
  params.driver.clock.restart_s = config.Number("restart_s", {0.2, 60.0});
  params.clock_window_s = config.Number("clock_window_s", {0.1, 60.0});
  params.warn_clock_error_s = config.Number("warn_clock_error_s", {0.0001, 1.0});
  params.max_clock_error_s = config.Number("max_clock_error_s", {params.warn_clock_error_s, 10.0});
  params.receive_buffer_bytes = config.Integer("receive_buffer_bytes", 65536, 1 << 26);
  config.Finish();
  return params;
}

}  // namespace hairpin
