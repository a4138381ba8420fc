#include "tools/simulator/race_control.hpp"

#include <cmath>

#include "common/clock.hpp"
#include "tools/simulator/require.hpp"

namespace hairpin {

RaceControl::RaceControl(const RaceControlParams& params, const Car& car)
    : params_(params), car_(car) {
  RequireWithin("mission", params.mission, vehicle_t::MISSION_ACCELERATION,
                vehicle_t::MISSION_AUTOCROSS);
  RequireWithin("go_after_ready", params.go_after_ready_s, 5.0, 60.0);
  RequireWithin("brakes_engaged_pressure", params.brakes_engaged_pressure, 0.0, 1.0);
  RequireNotNegative("res_stop_speed", params.res_stop_speed_mps);
}

bool RaceControl::PressesStop(const VehicleState& state) const {
  return params_.res_stop_speed_mps > 0.0 && state.velocity.vx >= params_.res_stop_speed_mps;
}

vehicle_t RaceControl::Vehicle(int64_t utime, const Actuators& actuators,
                               const VehicleState& state) {
  if (actuators.state() != as_state_t::STATE_READY) ready_since_.reset();
  if (actuators.state() == as_state_t::STATE_READY && !ready_since_) ready_since_ = utime;
  if (ready_since_ && SecondsBetween(*ready_since_, utime) >= params_.go_after_ready_s) go_ = true;
  vehicle_t message{};
  message.utime = utime;
  message.mission = params_.mission;
  message.master_switch_on = 1;
  message.tractive_system_on = actuators.shutdown_circuit_closed() ? 1 : 0;
  message.shutdown_circuit_closed = actuators.shutdown_circuit_closed() ? 1 : 0;
  message.brakes_engaged = state.brake >= params_.brakes_engaged_pressure ? 1 : 0;
  message.brakes_ok = 1;
  message.ebs_state = vehicle_t::EBS_ARMED;
  if (actuators.ebs_activated()) message.ebs_state = vehicle_t::EBS_ACTIVATED;
  message.res_go = go_ && !actuators.res_stop() ? 1 : 0;
  message.res_stop = actuators.res_stop() ? 1 : 0;
  for (const double speed : state.wheel_speed)
    message.speed_mps += 0.25 * std::abs(speed) * car_.wheel_radius;
  return message;
}

}  // namespace hairpin
