#include "daemons/can_gateway/supervision.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/clock.hpp"
#include "hairpin/as_state_t.hpp"

namespace hairpin {
namespace {

// A report may be ahead of what the gateway has heard on the bus by no more than that.
constexpr double kMaxAhead = 0.2;  // s

std::string TimeProblem(int64_t utime, int64_t newest, int64_t now) {
  if (utime < newest) return "older than the last one";
  if (now != 0 && SecondsBetween(now, utime) > kMaxAhead) return "its time lies in the future";
  return {};
}

}  // namespace

Supervision::Supervision(const SupervisionParams& params) : params_(params) {
  Check(params.deadman);
  if (!(params.supervisor_timeout > 0.0) || !(params.bus_silence > 0.0) ||
      !(params.wheel_speeds_timeout > 0.0))
    throw std::invalid_argument("supervision: a time-out must be > 0");
}

bool Supervision::driving() const { return as_.state == as_state_t::STATE_DRIVING; }

bool Supervision::manual() const {
  return as_.state == as_state_t::STATE_MANUAL && emergency_.empty();
}

bool Supervision::armed() const { return driving() || as_.state == as_state_t::STATE_READY; }

std::string Supervision::Hear(const AsReport& report, int64_t now) {
  std::string problem = TimeProblem(report.utime, as_.utime, now);
  if (!problem.empty()) return problem;
  const bool drove = driving();
  as_ = report;
  if (!driving()) was_safe_ = true;
  if (driving() && !drove) {
    driving_since_ = report.utime;
    actuator_stop_ = false;
  }
  return {};
}

std::string Supervision::Hear(const SupervisorReport& report, int64_t now) {
  std::string problem = TimeProblem(report.utime, supervisor_.utime, now);
  if (problem.empty()) supervisor_ = report;
  return problem;
}

bool Supervision::IsFresh(int64_t utime, int64_t now) const {
  return utime > 0 && SecondsBetween(utime, now) <= params_.supervisor_timeout;
}

DeadmanStage Supervision::StageOfCommand(int64_t now) const {
  if (!driving()) return DeadmanStage::kFresh;
  // Before the first command of this drive, its age counts from the state's change.
  const int64_t since = std::max(command_utime_, driving_since_);
  return StageAt(SecondsBetween(since, now), params_.deadman);
}

std::string Supervision::FindEmergency(const CarSituation& input) const {
  if (as_.state == as_state_t::STATE_EMERGENCY) return "AS Emergency";
  if (!armed()) return {};
  if (!was_safe_) return "the car drove when this daemon started";
  if (supervisor_.emergency) return "the watchdog asks for it";
  if (!IsFresh(as_.utime, input.now)) return "AS_STATE has ceased";
  if (!IsFresh(supervisor_.utime, input.now)) return "PIPELINE_STATUS has ceased";
  if (input.bus == CanState::kBusOff) return "CAN bus-off";
  if (input.bus == CanState::kDown) return "the CAN interface is down";
  if (input.bus_silence > params_.bus_silence) return "the CAN bus is silent";
  if (!input.lost_state.empty()) return input.lost_state + " has ceased";
  if (!driving()) return {};
  if (stage_ == DeadmanStage::kSilent) return "commands have ceased";
  const bool wheels =
      SecondsBetween(input.wheel_speeds_utime, input.now) <= params_.wheel_speeds_timeout;
  if (stage_ == DeadmanStage::kNeutral && !wheels)
    return "commands have ceased, and no wheel speeds to stop by";
  if (input.actuators == ActuatorVerdict::kDiverge) return input.culprit + " diverges";
  return {};
}

std::string Supervision::FindStop(const CarSituation& input) {
  if (!driving()) return {};
  if (input.actuators != ActuatorVerdict::kAgree) actuator_stop_ = true;
  if (actuator_stop_) return "actuators disagree: " + input.culprit;
  if (stage_ >= DeadmanStage::kNeutral) return "commands have ceased";
  return {};
}

void Supervision::Judge(const CarSituation& input) {
  stage_ = StageOfCommand(input.now);
  if (emergency_.empty()) emergency_ = FindEmergency(input);
  if (!emergency_.empty()) stage_ = DeadmanStage::kSilent;
  stop_ = FindStop(input);
  heartbeat_ = emergency_.empty() && input.bus == CanState::kActive &&
               IsFresh(as_.utime, input.now) && IsFresh(supervisor_.utime, input.now);
}

}  // namespace hairpin
