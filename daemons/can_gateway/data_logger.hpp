#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/can/dbc.hpp"
#include "daemons/can_gateway/drive_order.hpp"
#include "daemons/can_gateway/measurements.hpp"

namespace hairpin {

/// What the rules' data logger is told.
struct LoggerInput {
  ImuSample imu;
  MotorsSample motors;
  SteeringSample steering;
  BrakeSample brake;
  VehicleSample vehicle;
  DriveOrder order;
  double target_speed = 0.0;  // m/s
  AsReport as;
  bool steering_on = false;
  int cones = 0;      // in the local map
  int cones_all = 0;  // in the global map
  double max_wheel_torque = 0.0;
};

/// The frames 0x500 to 0x502, of values within their ranges [Formula Student Germany rules, data
/// logger].
std::array<CanFrame, 3> DataLoggerFrames(const LoggerInput& input);

}  // namespace hairpin
