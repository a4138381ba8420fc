#pragma once

#include <cstdint>
#include <string>

#include "common/can/deadman.hpp"
#include "common/car.hpp"
#include "hairpin/as_state_t.hpp"
#include "hairpin/drive_command_t.hpp"
#include "tools/simulator/vehicle.hpp"

namespace hairpin {

struct ActuatorParams {
  double hold_after_s = 0.0;       // a command older than this is held, and counted
  double brake_after_s = 0.0;      // then: no torque, brakes
  double emergency_after_s = 0.0;  // then: emergency brake
  double state_timeout_s = 0.0;    // AS_STATE older than this while driving: emergency brake
  double deadman_brake = 0.0;      // 0 to 1, where commands are missing
  double parking_brake = 0.0;      // 0 to 1, where the car is to stand
};

/// The CAN side of the actuators: takes commands while AS_STATE allows, brakes when they cease, and
/// brakes for good when they do not come back (the emergency brake system, EBS) [FAULTS, deadman
/// 50/100/200 ms]. Time is simulated time.
class Actuators {
 public:
  /// Throws std::invalid_argument for values that cannot be.
  Actuators(const ActuatorParams& params, const Car& car);

  /// Takes a command, its values limited to the car's. Returns why it was refused, empty if it was
  /// not: time that does not rise or lies past `now`, values that are not finite.
  std::string OnCommand(const drive_command_t& command, int64_t now);
  /// The same for the state of the autonomous system.
  std::string OnState(const as_state_t& state, int64_t now);
  /// Remote emergency stop: opens the circuit, for good.
  void StopByRes();
  /// Anything else that opens it.
  void OpenCircuit(const std::string& why) { Emergency(why); }

  /// What the actuators do at `now`, for wheels that stand at `steering_angle` [rad].
  VehicleInput Act(int64_t now, double steering_angle);

  int32_t state() const { return state_.state; }
  bool mission_finished() const { return state_.mission_finished; }
  DeadmanStage deadman() const { return deadman_; }
  /// Times that a fresh command was missing.
  int64_t held() const { return held_; }
  bool ebs_activated() const { return ebs_activated_; }
  /// False once an emergency has opened it. The brake that keeps a finished car standing does not.
  bool shutdown_circuit_closed() const { return emergency_.empty(); }
  bool res_stop() const { return res_stop_; }
  /// Why the circuit is open, empty if it is not.
  const std::string& emergency() const { return emergency_; }

 private:
  void Emergency(const std::string& why);
  void Watch(int64_t now);
  VehicleInput Drive();

  ActuatorParams params_;
  Car car_;
  VehicleInput command_;
  int64_t command_utime_ = 0;
  as_state_t state_{};
  int64_t driving_since_ = 0;
  DeadmanStage deadman_ = DeadmanStage::kFresh;
  int64_t held_ = 0;
  bool ebs_activated_ = false;
  bool res_stop_ = false;
  std::string emergency_;
};

}  // namespace hairpin
