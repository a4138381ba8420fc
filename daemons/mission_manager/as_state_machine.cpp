#include "daemons/mission_manager/as_state_machine.hpp"

#include <stdexcept>

#include "common/clock.hpp"

namespace hairpin {

AsStateMachine::AsStateMachine(double go_delay) : go_delay_(go_delay) {
  if (!(go_delay >= 0.0)) throw std::invalid_argument("AsStateMachine: go_delay_s must be >= 0");
}

AsState AsStateMachine::Enter(AsState state, const std::string& reason) {
  state_ = state;
  reason_ = reason;
  return state_;
}

std::optional<std::string> AsStateMachine::Emergency(const AsInput& input) const {
  const bool armed = state_ != AsState::kOff;
  if (input.res_stop && armed) return "stopped by the RES";
  // After the finish the EBS holds the car, and has opened the circuit.
  if (state_ == AsState::kFinished || (input.mission_finished && input.standstill)) {
    return std::nullopt;
  }
  if (input.ebs_activated) return "the EBS is activated";
  if (!input.shutdown_circuit_closed && armed) return "the shutdown circuit is open";
  return std::nullopt;
}

std::string AsStateMachine::WhyOff(const AsInput& input) const {
  if (!input.mission_problem.empty()) return input.mission_problem;
  if (!input.master_switch_on) return "the master switch is off";
  if (!input.brakes_ok) return "the brake system is not ok";
  if (!input.tractive_system_on) return "the tractive system is off";
  if (state_ == AsState::kDriving) return {};
  if (input.res_stop) return "the RES is pressed";
  if (!input.shutdown_circuit_closed) return "the shutdown circuit is open";
  if (!input.brakes_engaged) return "the brakes are not engaged";
  return input.system_problem;
}

AsState AsStateMachine::WaitForGo(const AsInput& input) {
  if (state_ != AsState::kReady) {
    ready_utime_ = input.utime;
    go_was_released_ = false;
  }
  if (!input.res_go) go_was_released_ = true;
  const bool early = SecondsBetween(ready_utime_, input.utime) < go_delay_;
  if (input.res_go && go_was_released_ && !early) return Enter(AsState::kDriving, "Go received");
  if (early) return Enter(AsState::kReady, "Go not accepted yet");
  return Enter(AsState::kReady, go_was_released_ ? "waiting for Go" : "Go must be released first");
}

AsState AsStateMachine::Update(const AsInput& input) {
  if (state_ == AsState::kEmergency) return state_;
  if (const auto emergency = Emergency(input)) return Enter(AsState::kEmergency, *emergency);
  if (state_ == AsState::kFinished) return state_;
  if (state_ == AsState::kDriving && input.mission_finished && input.standstill) {
    return Enter(AsState::kFinished, "mission finished, standing");
  }
  if (const std::string why = WhyOff(input); !why.empty()) return Enter(AsState::kOff, why);
  if (state_ != AsState::kDriving) return WaitForGo(input);
  return Enter(AsState::kDriving,
               input.mission_finished ? "mission finished, stopping" : "driving");
}

}  // namespace hairpin
