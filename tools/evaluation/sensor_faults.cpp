#include "tools/evaluation/sensor_faults.hpp"

#include <algorithm>
#include <random>

namespace hairpin {
namespace {

constexpr double kScale = 1.3;
constexpr double kSpikeShare = 0.1;
constexpr double kSpeedSpike = 10.0;         // m/s
constexpr double kWheelSpike = 40.0;         // rad/s: about 10 m/s at the tyre
constexpr double kAccelerationSpike = 20.0;  // m/s^2
constexpr double kYawRateSpike = 3.0;        // rad/s

/// The deviates of one faulty reading; zero where this one does not spike.
class Spikes {
 public:
  double Next(double size) { return hits_ ? size * normal_(random_) : 0.0; }
  void Draw() { hits_ = uniform_(random_) < kSpikeShare; }

 private:
  std::mt19937 random_{1};
  std::uniform_real_distribution<double> uniform_;
  std::normal_distribution<double> normal_;
  bool hits_ = false;
};

void Spoil(double& value, double last, FaultKind kind, double spike) {
  switch (kind) {
    case FaultKind::kRemoved:
      value = 0.0;
      return;
    case FaultKind::kFrozen:
      value = last;
      return;
    case FaultKind::kScaled:
      value *= kScale;
      return;
    case FaultKind::kSpiking:
      value += spike;
      return;
  }
}

/// Applies `spoil(reading, last good one)` from `from` on; erases instead where `is_removed`.
template <class Reading, class Function>
void SpoilFrom(std::vector<Reading>& readings, int64_t from, bool is_removed, Function spoil) {
  const auto first = std::find_if(readings.begin(), readings.end(),
                                  [from](const Reading& reading) { return reading.utime >= from; });
  if (is_removed) {
    readings.erase(first, readings.end());
    return;
  }
  if (first == readings.begin() || first == readings.end()) return;
  const Reading last = *(first - 1);
  std::for_each(first, readings.end(), [&](Reading& reading) { spoil(reading, last); });
}

}  // namespace

std::string_view NameOf(FaultySensor sensor) {
  switch (sensor) {
    case FaultySensor::kImu:
      return "imu";
    case FaultySensor::kGyro:
      return "gyro";
    case FaultySensor::kAccelerometer:
      return "accelerometer";
    case FaultySensor::kOptical:
      return "optical";
    case FaultySensor::kWheels:
      return "wheels";
    case FaultySensor::kOneWheel:
      return "one_wheel";
  }
  return "unknown";
}

std::string_view NameOf(FaultKind kind) {
  switch (kind) {
    case FaultKind::kRemoved:
      return "removed";
    case FaultKind::kFrozen:
      return "frozen";
    case FaultKind::kScaled:
      return "scaled";
    case FaultKind::kSpiking:
      return "spiking";
  }
  return "unknown";
}

SensorRecording WithFault(const SensorRecording& recording, FaultySensor sensor, FaultKind kind,
                          int64_t from) {
  SensorRecording faulty = recording;
  Spikes spikes;
  const bool is_removed = kind == FaultKind::kRemoved;
  const bool is_gyro = sensor == FaultySensor::kImu || sensor == FaultySensor::kGyro;
  const bool is_accelerometer =
      sensor == FaultySensor::kImu || sensor == FaultySensor::kAccelerometer;
  if (is_gyro || is_accelerometer) {
    const auto spoil = [&](ImuReading& reading, const ImuReading& last) {
      spikes.Draw();
      if (is_gyro) Spoil(reading.yaw_rate, last.yaw_rate, kind, spikes.Next(kYawRateSpike));
      for (int axis = 0; is_accelerometer && axis < 2; ++axis)
        Spoil(reading.acceleration[axis], last.acceleration[axis], kind,
              spikes.Next(kAccelerationSpike));
    };
    SpoilFrom(faulty.imu, from, is_removed && sensor == FaultySensor::kImu, spoil);
  } else if (sensor == FaultySensor::kOptical) {
    const auto spoil = [&](GroundSpeedReading& reading, const GroundSpeedReading& last) {
      spikes.Draw();
      for (int axis = 0; axis < 2; ++axis)
        Spoil(reading.velocity[axis], last.velocity[axis], kind, spikes.Next(kSpeedSpike));
    };
    SpoilFrom(faulty.ground_speed, from, is_removed, spoil);
  } else {
    const auto spoil = [&](MotorsReading& reading, const MotorsReading& last) {
      spikes.Draw();
      for (size_t i = 0; i < 4; ++i) {
        if (sensor == FaultySensor::kOneWheel && i != 2) continue;
        Spoil(reading.speed[i], last.speed[i], kind, spikes.Next(kWheelSpike));
      }
    };
    SpoilFrom(faulty.motors, from, is_removed && sensor == FaultySensor::kWheels, spoil);
  }
  return faulty;
}

}  // namespace hairpin
