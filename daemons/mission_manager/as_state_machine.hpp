#pragma once

#include <cstdint>
#include <string>

#include "hairpin/as_state_t.hpp"
#include "hairpin/vehicle_t.hpp"

namespace hairpin {

/// The first five numbered as on the wire and in the rules' data logger frame.
enum class AsState {
  kOff = as_state_t::STATE_OFF,
  kReady = as_state_t::STATE_READY,
  kDriving = as_state_t::STATE_DRIVING,
  kEmergency = as_state_t::STATE_EMERGENCY,
  kFinished = as_state_t::STATE_FINISHED,
  kManual = as_state_t::STATE_MANUAL,
};

/// State of the emergency brake system.
enum class Ebs {
  kUnknown = vehicle_t::EBS_UNKNOWN,
  kUnavailable = vehicle_t::EBS_UNAVAILABLE,
  kArmed = vehicle_t::EBS_ARMED,
  kActivated = vehicle_t::EBS_ACTIVATED,
};

/// What the rules look at, at one time.
struct AsInput {
  int64_t utime = 0;
  int32_t mission = vehicle_t::MISSION_UNKNOWN;  // selected
  std::string mission_problem;  // why the mission selected cannot be driven, empty: it can
  std::string system_problem;   // why the software is not ready, empty: it is
  bool master_switch_on = false;
  bool tractive_system_on = false;
  bool shutdown_circuit_closed = false;
  bool brakes_engaged = false;
  bool brakes_ok = false;
  Ebs ebs = Ebs::kUnknown;
  bool res_go = false;
  bool res_stop = false;
  bool mission_finished = false;
  bool standstill = false;
};

/// Where the state machine stands.
struct AsStatus {
  AsState state = AsState::kOff;
  std::string reason = "nothing heard yet";      // for people: why the state is what it is
  int32_t mission = vehicle_t::MISSION_UNKNOWN;  // with which Off was left
  int64_t ready_utime = 0;                       // when Ready was entered
  bool go_was_released = false;                  // while Ready
};

/// The state machine of the autonomous system [Formula Student Germany rules, "AS states"],
/// evaluated continuously: the status that follows `status` when the car is as in `input`.
///
/// * EBS activated: Finished where the mission is finished, the car stands, and the RES has not
///   opened the circuit; else Emergency. Emergency too where the RES stops the car in Ready,
///   Driving or Finished, or the shutdown circuit opens in Ready or Driving. It is final.
/// * Mission finished and the car stands: Finished, which is what makes the car engage its EBS. It
///   is left for Off with the master switch off and the EBS released.
/// * Mission manual: Manual while the master switch is off, the EBS unavailable and the tractive
///   system on; from and to Off only.
/// * Mission selected, master switch on, brake system ok, EBS armed, tractive system on? No: Off.
///   Off too where another mission is selected than the one that is on.
/// * Ready to drive: Driving. Go makes it so, at the earliest `go_delay` [s] after entering Ready
///   and pressed while Ready: a signal that has been on since before is a stuck one.
/// * Brakes engaged, mission known to this software and software ready: Ready. Else Off.
AsStatus NextAsStatus(const AsStatus& status, const AsInput& input, double go_delay);

/// NextAsStatus() over time.
class AsStateMachine {
 public:
  /// `go_delay` [s]. Throws std::invalid_argument if it is negative.
  explicit AsStateMachine(double go_delay);

  /// Returns the state after looking at `input`. Times must not decrease.
  AsState Update(const AsInput& input);

  AsState state() const { return status_.state; }
  const std::string& reason() const { return status_.reason; }
  const AsStatus& status() const { return status_; }

 private:
  double go_delay_;
  AsStatus status_;
};

}  // namespace hairpin
