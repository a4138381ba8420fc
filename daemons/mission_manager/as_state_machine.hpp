#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hairpin/as_state_t.hpp"

namespace hairpin {

/// Numbered as on the wire and in the rules' data logger frame.
enum class AsState {
  kOff = as_state_t::STATE_OFF,
  kReady = as_state_t::STATE_READY,
  kDriving = as_state_t::STATE_DRIVING,
  kEmergency = as_state_t::STATE_EMERGENCY,
  kFinished = as_state_t::STATE_FINISHED,
};

/// What the rules look at, at one time.
struct AsInput {
  int64_t utime = 0;
  std::string mission_problem;  // why the mission selected cannot be driven, empty: it can
  std::string system_problem;   // why the software is not ready, empty: it is
  bool master_switch_on = false;
  bool tractive_system_on = false;
  bool shutdown_circuit_closed = false;
  bool brakes_engaged = false;
  bool brakes_ok = false;
  bool ebs_activated = false;
  bool res_go = false;
  bool res_stop = false;
  bool mission_finished = false;
  bool standstill = false;
};

/// The state machine of the autonomous system [Formula Student Germany rules, "AS states"],
/// evaluated continuously:
///
/// * EBS activated, RES stop, or the shutdown circuit opened while Ready or Driving: Emergency, for
/// ever. But where
///   the mission is finished and the car stands, EBS activation and the open circuit mean Finished.
/// * Mission selected, master switch on, brake system ok, tractive system on? No: Off.
/// * Ready to drive: Driving. That is set by Go, at the earliest `go_delay` after entering Ready,
/// pressed while Ready: a
///   signal that has been on since before is a stuck one. It is lost with Driving.
/// * Brakes engaged, mission known to this software and software ready: Ready. Else Off.
///
/// Until a CAN gateway reports the EBS, standing on the service brake after the mission counts as
/// Finished too.
class AsStateMachine {
 public:
  /// `go_delay` [s]. Throws std::invalid_argument if it is negative.
  explicit AsStateMachine(double go_delay);

  /// Returns the state after looking at `input`. Times must not decrease.
  AsState Update(const AsInput& input);

  AsState state() const { return state_; }
  /// For people: why the state is what it is.
  const std::string& reason() const { return reason_; }

 private:
  AsState Enter(AsState state, const std::string& reason);
  std::optional<std::string> Emergency(const AsInput& input) const;
  std::string WhyOff(const AsInput& input) const;
  AsState WaitForGo(const AsInput& input);

  double go_delay_;
  AsState state_ = AsState::kOff;
  std::string reason_ = "nothing heard yet";
  int64_t ready_utime_ = 0;       // when Ready was entered
  bool go_was_released_ = false;  // while Ready
};

}  // namespace hairpin
