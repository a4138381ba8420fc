#include "tools/simulator/actuators.hpp"

#include <algorithm>
#include <cmath>

#include "common/clock.hpp"
#include "tools/simulator/require.hpp"

namespace hairpin {
namespace {

std::string TimeProblem(int64_t utime, int64_t newest, int64_t now) {
  if (utime <= newest) return "its time does not rise";
  if (utime > now) return "its time lies in the future";
  return {};
}

}  // namespace

Actuators::Actuators(const ActuatorParams& params, const Car& car) : params_(params), car_(car) {
  RequirePositive("hold_after", params.hold_after_s);
  RequireWithin("brake_after", params.brake_after_s, params.hold_after_s, 1.0);
  RequireWithin("emergency_after", params.emergency_after_s, params.brake_after_s, 1.0);
  RequireWithin("state_timeout", params.state_timeout_s, 0.05, 1.0);
  RequireWithin("deadman_brake", params.deadman_brake, 0.0, 1.0);
  RequireWithin("parking_brake", params.parking_brake, 0.0, 1.0);
}

std::string Actuators::OnCommand(const drive_command_t& command, int64_t now) {
  std::string problem = TimeProblem(command.utime, command_utime_, now);
  if (!problem.empty()) return problem;
  const auto* torque = command.wheel_torque_nm;
  if (!std::isfinite(command.steering_angle_rad) || !std::isfinite(command.brake) ||
      !std::all_of(torque, torque + 4, [](double value) { return std::isfinite(value); })) {
    return "a value is not finite";
  }
  command_utime_ = command.utime;
  command_.steering_angle =
      std::clamp(command.steering_angle_rad, -car_.max_steering_angle, car_.max_steering_angle);
  for (size_t i = 0; i < 4; ++i) {
    command_.wheel_torque[i] = std::clamp(torque[i], -car_.max_wheel_torque, car_.max_wheel_torque);
  }
  command_.brake = std::clamp(command.brake, 0.0, 1.0);
  return {};
}

std::string Actuators::OnState(const as_state_t& state, int64_t now) {
  // Sent again at a change: the same time may come twice.
  std::string problem = TimeProblem(state.utime, state_.utime - 1, now);
  if (!problem.empty()) return problem;
  const bool drove = state_.state == as_state_t::STATE_DRIVING;
  state_ = state;
  if (!drove && state.state == as_state_t::STATE_DRIVING) driving_since_ = state.utime;
  return {};
}

void Actuators::StopByRes() {
  res_stop_ = true;
  Emergency("stopped by the RES");
}

void Actuators::Emergency(const std::string& why) {
  if (emergency_.empty()) emergency_ = why;
  ebs_activated_ = true;
}

void Actuators::Watch(int64_t now) {
  if (state_.state == as_state_t::STATE_EMERGENCY) Emergency("AS Emergency: " + state_.reason);
  deadman_ = DeadmanStage::kFresh;
  if (state_.state != as_state_t::STATE_DRIVING) return;
  if (SecondsBetween(state_.utime, now) > params_.state_timeout_s) Emergency("AS_STATE has ceased");
  // Before the first command of this drive, its age counts from the state's change.
  const int64_t since = std::max(command_utime_, driving_since_);
  deadman_ = StageAt(SecondsBetween(since, now),
                     {params_.hold_after_s, params_.brake_after_s, params_.emergency_after_s});
  if (deadman_ == DeadmanStage::kSilent) Emergency("commands have ceased");
  if (deadman_ != DeadmanStage::kFresh) ++held_;
}

VehicleInput Actuators::Act(int64_t now, double steering_angle) {
  Watch(now);
  // The brake that a finished car is left with is the same spring; it opens no circuit.
  if (state_.state == as_state_t::STATE_FINISHED) ebs_activated_ = true;
  VehicleInput input;
  input.steering_angle = steering_angle;
  if (ebs_activated_) {
    input.brake = 1.0;
    return input;
  }
  if (state_.state == as_state_t::STATE_DRIVING) return Drive();
  input.brake = params_.parking_brake;
  return input;
}

VehicleInput Actuators::Drive() {
  VehicleInput input = command_;
  if (deadman_ >= DeadmanStage::kNeutral) {
    input.wheel_torque.fill(0.0);
    input.brake = std::max(params_.deadman_brake, command_.brake);
  }
  return input;
}

}  // namespace hairpin
