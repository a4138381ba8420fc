#pragma once

#include "common/config.hpp"
#include "tools/simulator/actuators.hpp"
#include "tools/simulator/cone_sensor.hpp"
#include "tools/simulator/gnss_receiver.hpp"
#include "tools/simulator/lidar/lidar_rig.hpp"
#include "tools/simulator/motion_sensors.hpp"
#include "tools/simulator/race_control.hpp"
#include "tools/simulator/referee.hpp"
#include "tools/simulator/vehicle.hpp"

namespace hairpin {

struct SimulatorParams {
  VehicleParams vehicle;
  ActuatorParams actuators;
  MotionSensorParams motion_sensors;
  GnssReceiverParams gnss_receiver;
  ConeSensorParams fusion;
  ConeSensorParams lidar;
  ConeSensorParams camera;
  double cone_delay_s = 0.0;  // from the scan until its message
  LidarRigParams lidars;
  RefereeParams referee;
  RaceControlParams race_control;
};

/// Reads all of `simulator.yaml` and finishes `config`: read what else is wanted of it, such as
/// LoadCar(), before. Throws ConfigError.
SimulatorParams LoadSimulatorParams(const Config& config);

}  // namespace hairpin
