#pragma once

#include <cstdint>
#include <string_view>

#include "tools/evaluation/sensor_recording.hpp"

namespace hairpin {

/// Which readings of a recording go wrong. `kGyro` and `kAccelerometer` are halves of `kImu`;
/// `kOneWheel` is the rear left one of `kWheels`. GPS is not among them: it is the reference.
enum class FaultySensor { kImu, kGyro, kAccelerometer, kOptical, kWheels, kOneWheel };
enum class FaultKind { kRemoved, kFrozen, kScaled, kSpiking };
std::string_view NameOf(FaultySensor sensor);
std::string_view NameOf(FaultKind kind);

/// The recording with one sensor faulty from `from` on:
///   removed: no readings; not for half an IMU or one wheel of four, whose message goes on: frozen
///            at zero instead
///   frozen:  the last reading again and again with fresh times
///   scaled:  by 1.3
///   spiking: one reading in ten off by a normal deviate of 10 m/s, 20 m/s^2, 3 rad/s; seeded
SensorRecording WithFault(const SensorRecording& recording, FaultySensor sensor, FaultKind kind,
                          int64_t from);

}  // namespace hairpin
