#pragma once

#include <array>
#include <cstdint>
#include <variant>

namespace hairpin {

// What the frames of one measurement say together. SI; wheels in the order fl fr rl rr.

struct ImuSample {
  int64_t utime = 0;
  std::array<double, 3> acceleration{};  // in base, without gravity
  std::array<double, 3> angular_rate{};
};

struct GroundSpeedSample {
  int64_t utime = 0;
  std::array<double, 2> velocity{};  // of the sensor's place: forward, left
  double quality = 0.0;              // 0 to 1
};

struct MotorsSample {
  int64_t utime = 0;
  std::array<double, 4> speed{};   // [rad/s]
  std::array<double, 4> torque{};  // [N m]
};

struct SteeringSample {
  int64_t utime = 0;
  double angle = 0.0;
};

struct BrakeSample {
  int64_t utime = 0;
  double level = 0.0;  // 0 to 1 of full pressure
};

struct VehicleSample {
  int64_t utime = 0;
  int mission = 0;  // numbered as in vehicle_t
  bool master_switch_on = false;
  bool tractive_system_on = false;
  bool shutdown_circuit_closed = false;
  bool brakes_engaged = false;
  bool brakes_ok = false;
  int ebs_state = 0;  // numbered as in vehicle_t
  bool res_go = false;
  bool res_stop = false;
  double speed = 0.0;  // from the wheels, >= 0
};

using Measurement = std::variant<ImuSample, GroundSpeedSample, MotorsSample, SteeringSample,
                                 BrakeSample, VehicleSample>;

}  // namespace hairpin
