#pragma once

#include <cstdint>
#include <string>

#include "common/can/can_port.hpp"
#include "common/can/deadman.hpp"
#include "daemons/can_gateway/actuator_monitor.hpp"
#include "daemons/can_gateway/drive_order.hpp"

namespace hairpin {

struct SupervisionParams {
  DeadmanLimits deadman;
  double supervisor_timeout = 0.0;    // [s], > 0: of AS_STATE and PIPELINE_STATUS
  double bus_silence = 0.0;           // [s] of wall without a frame, > 0
  double wheel_speeds_timeout = 0.0;  // [s], > 0
};

/// What there is to know at one time.
struct CarSituation {
  int64_t now = 0;           // car time
  double bus_silence = 0.0;  // s of wall
  CanState bus = CanState::kActive;
  int64_t wheel_speeds_utime = 0;  // 0: none
  std::string lost_state;          // of the car, empty: none
  ActuatorVerdict actuators = ActuatorVerdict::kAgree;
  std::string culprit;  // the actuator's name
};

/// Who may move the car: the mission manager by AS_STATE, the watchdog by PIPELINE_STATUS, commands
/// by their age. Once the car is armed (Ready or Driving) the loss of any of these, of the bus, or
/// of the car's state ends the heartbeat for good: nothing but a restart of this daemon arms again,
/// and none that finds the car driving [FAULTS 6, 24, 29, 30, 32].
class Supervision {
 public:
  /// Throws std::invalid_argument for parameters out of bounds.
  explicit Supervision(const SupervisionParams& params);

  /// Return why a report was refused, empty if it was not.
  std::string Hear(const AsReport& report, int64_t now);
  std::string Hear(const SupervisorReport& report, int64_t now);
  /// A command was taken.
  void HearCommand(int64_t utime) { command_utime_ = utime; }

  /// To be called before the next four are asked.
  void Judge(const CarSituation& input);
  DeadmanStage stage() const { return stage_; }
  /// Why the car stops by itself, empty if it does not: no torque, service brake.
  const std::string& stop() const { return stop_; }
  /// Why the heartbeat has ceased for good, empty if it has not.
  const std::string& emergency() const { return emergency_; }
  /// Whether the heartbeat to the shutdown circuit is to go out.
  bool heartbeat() const { return heartbeat_; }

  const AsReport& as() const { return as_; }
  bool driving() const;
  /// The car is the driver's: no actuator is to act, whatever else is to be said of it.
  bool manual() const;
  /// Car time since which the car drives.
  int64_t driving_since() const { return driving_since_; }
  bool controlled_stop() const { return supervisor_.stop; }

 private:
  bool armed() const;
  bool IsFresh(int64_t utime, int64_t now) const;
  std::string FindEmergency(const CarSituation& input) const;
  std::string FindStop(const CarSituation& input);
  DeadmanStage StageOfCommand(int64_t now) const;

  SupervisionParams params_;
  AsReport as_;
  SupervisorReport supervisor_;
  int64_t command_utime_ = 0;
  int64_t driving_since_ = 0;
  bool was_safe_ = false;  // not Driving was heard once
  bool actuator_stop_ = false;
  DeadmanStage stage_ = DeadmanStage::kFresh;
  std::string stop_;
  std::string emergency_;
  bool heartbeat_ = false;
};

}  // namespace hairpin
