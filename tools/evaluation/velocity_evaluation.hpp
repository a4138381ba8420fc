#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "daemons/velocity_estimator/velocity_estimator.hpp"
#include "tools/evaluation/sensor_faults.hpp"
#include "tools/evaluation/sensor_recording.hpp"

namespace hairpin {

/// The estimator's answer and the pose that its answers so far integrate to, zero at the start.
struct DeadReckoned {
  VelocityEstimate estimate;
  Pose2 T_local_base;
};
using DeadReckoning = std::vector<DeadReckoned>;

/// Lets the estimator hear the recording in order of time. It is led by the IMU, or by what is left
/// where that is silent, as in the daemon.
DeadReckoning RunEstimator(const SensorRecording& recording, const VelocityEstimatorParams& params);

/// Dead-reckoned antenna against GPS, after one rigid alignment in the plane.
struct PositionComparison {
  Pose2 T_enu_local;
  double rms_m = 0.0;
};
/// Over the fixes while the car drives. Empty for fewer than two.
std::optional<PositionComparison> ComparePosition(const DeadReckoning& run,
                                                  const SensorRecording& recording,
                                                  const Drive& drive, const Car& car);

/// What a fault did to the velocity, against the run without it.
struct FaultOutcome {
  FaultySensor sensor = FaultySensor::kImu;
  FaultKind kind = FaultKind::kRemoved;
  double max_mps = 0.0;    // largest change of the velocity of base
  double longest_s = 0.0;  // of a change by more than kChanged
  bool is_always_valid = true;
  static constexpr double kChanged = 0.3;  // m/s
  static constexpr double kTooLong = 0.5;  // s
  bool IsBorne() const { return longest_s <= kTooLong; }
};

struct VelocityReport {
  SensorRecording recording;
  Drive drive;
  DeadReckoning run;
  std::optional<PositionComparison> position;
  DeadReckoning without_imu;
  DeadReckoning without_optical;
  DeadReckoning without_wheels;
  std::vector<FaultOutcome> faults;
};

/// Runs the estimator on all sensors, without each, and with each fault from the middle of the
/// drive on.
VelocityReport EvaluateVelocity(const SensorRecording& recording,
                                const VelocityEstimatorParams& params);

/// The figures. `without.gnss` equals the run with all: these recordings' GPS tells neither
/// velocity nor heading, so the estimator never hears it.
nlohmann::json ToJson(const VelocityReport& report, const VelocityEstimatorParams& params);

}  // namespace hairpin
