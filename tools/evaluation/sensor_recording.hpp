#pragma once

#include <string>
#include <vector>

#include "common/local_enu.hpp"
#include "daemons/velocity_estimator/measurements.hpp"
#include "tools/evaluation/recording_error.hpp"

namespace hairpin {

struct GpsFix {
  int64_t utime = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // ENU from the first fix [m]
};

/// What a car's sensors said during one drive, each in order of time. GPS tells positions only.
struct SensorRecording {
  std::vector<ImuReading> imu;
  std::vector<GroundSpeedReading> ground_speed;
  std::vector<MotorsReading> motors;
  std::vector<GpsFix> gps;
};

/// How columns turn into readings: `recording.yaml` beside the car's other files.
struct RecordingScale {
  double motor_rpm_per_mps = 0.0;
  double wheel_radius = 0.0;  // m
};

/// Reads the four CSV files of a folder: imu_200hz (t_s, wx, wy, wz, ax, ay, az),
/// optical_speed_250hz (t_s, vx, vy), wheel_rpm_100hz (t_s, fl, fr, rl, rr), gps_10hz (t_s,
/// lat_deg, lon_deg); SI, seconds since the Unix epoch, one line of names first. Rows whose time
/// does not increase are left out. Throws RecordingError.
SensorRecording LoadSensorRecording(const std::string& folder, const RecordingScale& scale);

/// The time from the first to the last moment at which the car moves, by its wheels; the whole
/// recording where it always does. Throws RecordingError where it never does.
struct Drive {
  int64_t from = 0;
  int64_t to = 0;
  bool Holds(int64_t utime) const { return utime >= from && utime <= to; }
};
Drive DriveOf(const SensorRecording& recording, double wheel_radius);

}  // namespace hairpin
