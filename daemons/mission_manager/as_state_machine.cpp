#include "daemons/mission_manager/as_state_machine.hpp"

#include <optional>
#include <stdexcept>

#include "common/clock.hpp"

namespace hairpin {
namespace {

bool StandsAfterTheMission(const AsStatus& status, const AsInput& input) {
  return status.state == AsState::kDriving && input.mission_finished && input.standstill;
}

std::optional<std::string> WhyEmergency(const AsStatus& status, const AsInput& input) {
  const AsState state = status.state;
  const bool armed = state == AsState::kReady || state == AsState::kDriving;
  if (input.res_stop && (armed || state == AsState::kFinished)) return "stopped by the RES";
  // After the finish the EBS holds the car, and has opened the circuit.
  if (state == AsState::kFinished || StandsAfterTheMission(status, input)) return std::nullopt;
  if (input.ebs == Ebs::kActivated) return "the EBS is activated";
  if (!input.shutdown_circuit_closed && armed) return "the shutdown circuit is open";
  return std::nullopt;
}

// Empty: the driver has the car.
std::string WhyNotManual(const AsInput& input) {
  if (input.mission != vehicle_t::MISSION_MANUAL) return "mission manual is not selected";
  if (input.master_switch_on) return "mission manual: the master switch is on";
  if (input.ebs != Ebs::kUnavailable) return "mission manual: the EBS is not unavailable";
  if (!input.tractive_system_on) return "mission manual: the tractive system is off";
  return {};
}

std::string WhyOff(const AsStatus& status, const AsInput& input) {
  const bool on = status.state == AsState::kReady || status.state == AsState::kDriving;
  if (on && input.mission != status.mission) return "the mission was changed";
  if (!input.mission_problem.empty()) return input.mission_problem;
  if (!input.master_switch_on) return "the master switch is off";
  if (!input.brakes_ok) return "the brake system is not ok";
  if (input.ebs != Ebs::kArmed) return "the EBS is not armed";
  if (!input.tractive_system_on) return "the tractive system is off";
  if (status.state == AsState::kDriving) return {};
  if (input.res_stop) return "the RES is pressed";
  if (!input.shutdown_circuit_closed) return "the shutdown circuit is open";
  if (!input.brakes_engaged) return "the brakes are not engaged";
  return input.system_problem;
}

AsStatus Enter(AsStatus status, AsState state, const std::string& reason) {
  status.state = state;
  status.reason = reason;
  return status;
}

AsStatus WaitForGo(AsStatus status, const AsInput& input, double go_delay) {
  if (status.state != AsState::kReady) {
    status.mission = input.mission;
    status.ready_utime = input.utime;
    status.go_was_released = false;
  }
  if (!input.res_go) status.go_was_released = true;
  if (SecondsBetween(status.ready_utime, input.utime) < go_delay)
    return Enter(status, AsState::kReady, "Go not accepted yet");
  if (!status.go_was_released) return Enter(status, AsState::kReady, "Go must be released first");
  if (!input.res_go) return Enter(status, AsState::kReady, "waiting for Go");
  return Enter(status, AsState::kDriving, "Go received");
}

AsStatus AfterFinished(const AsStatus& status, const AsInput& input) {
  if (input.master_switch_on || input.ebs != Ebs::kUnavailable) return status;
  return Enter(status, AsState::kOff, "the mission is over");
}

}  // namespace

AsStatus NextAsStatus(const AsStatus& status, const AsInput& input, double go_delay) {
  if (status.state == AsState::kEmergency) return status;
  if (const auto why = WhyEmergency(status, input)) return Enter(status, AsState::kEmergency, *why);
  if (status.state == AsState::kFinished) return AfterFinished(status, input);
  if (StandsAfterTheMission(status, input))
    return Enter(status, AsState::kFinished, "mission finished, standing");
  if (status.state == AsState::kManual ||
      (status.state == AsState::kOff && input.mission == vehicle_t::MISSION_MANUAL)) {
    const std::string why = WhyNotManual(input);
    if (!why.empty()) return Enter(status, AsState::kOff, why);
    return Enter(status, AsState::kManual, "the driver has the car");
  }
  if (const std::string why = WhyOff(status, input); !why.empty())
    return Enter(status, AsState::kOff, why);
  if (status.state != AsState::kDriving) return WaitForGo(status, input, go_delay);
  return Enter(status, AsState::kDriving,
               input.mission_finished ? "mission finished, stopping" : "driving");
}

AsStateMachine::AsStateMachine(double go_delay) : go_delay_(go_delay) {
  if (!(go_delay >= 0.0)) throw std::invalid_argument("AsStateMachine: go_delay_s must be >= 0");
}

AsState AsStateMachine::Update(const AsInput& input) {
  status_ = NextAsStatus(status_, input, go_delay_);
  return status_.state;
}

}  // namespace hairpin
