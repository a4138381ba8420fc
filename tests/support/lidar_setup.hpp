#pragma once

#include <cstdlib>
#include <memory>
#include <numbers>
#include <string>

#include "common/config.hpp"
#include "daemons/lidar_driver/lidar_driver.hpp"
#include "daemons/lidar_driver/velodyne_decoder.hpp"

namespace hairpin {

/// Where recordings of real sensors lie, if they do.
inline std::string RealData() {
  const char* named = std::getenv("HAIRPIN_DATA");
  return named != nullptr ? named : HAIRPIN_SOURCE_DIR "/../shared/data";
}

/// The nominal calibration that is shipped: "lidar_vlp32c", "lidar_vlp16".
inline LidarCalibration ShippedCalibration(const std::string& name, size_t lasers) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  const Config file = Config::Load(HAIRPIN_SOURCE_DIR "/config", name);
  LidarCalibration calibration{file.Numbers("elevation_deg", lasers, {}),
                               file.Numbers("azimuth_offset_deg", lasers, {})};
  for (auto* angles : {&calibration.elevation, &calibration.azimuth_offset})
    for (double& angle : *angles) angle *= kDegree;
  return calibration;
}

inline VelodyneParams Vlp32c() {
  return {"VLP-32C", ShippedCalibration("lidar_vlp32c", 32), 0.3, 300.0};
}
inline VelodyneParams Vlp16() {
  return {"VLP-16", ShippedCalibration("lidar_vlp16", 16), 0.3, 120.0};
}

inline LidarDriver MakeDriver(const VelodyneParams& sensor, double cut_deg = 120.0,
                              double gnss_wait_s = 0.0) {
  LidarDriverParams params;
  params.clock = {gnss_wait_s, 10.0, 1.0};
  params.revolution = {cut_deg * std::numbers::pi / 180.0, 0.3};
  return LidarDriver(params, std::make_unique<VelodyneDecoder>(sensor));
}

}  // namespace hairpin
