#include "tools/simulator/can_car.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/can/sample_time.hpp"
#include "common/clock.hpp"

namespace hairpin {
namespace {

constexpr double kTimePeriod = 0.1;        // s, of CAR_TIME and TRACTIVE_SYSTEM
constexpr double kBatteryVoltage = 540.0;  // V
constexpr double kTorqueConstant = 4.0;    // N m per A, at the wheel
constexpr double kMinSlipSpeed = 0.5;      // m/s, below which the optical sensor gives no angle
constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr uint8_t kActuatorActive = 2;

template <class Integer>
Integer Percent(double share) {
  return static_cast<Integer>(std::lround(100.0 * std::clamp(share, 0.0, 1.0)));
}

template <class M>
M Torques(uint16_t time, double left, double right) {
  return {.sample_time = time,
          .left_torque_nm = left,
          .right_torque_nm = right,
          .left_current_a = left / kTorqueConstant,
          .right_current_a = right / kTorqueConstant};
}

}  // namespace

template <class M>
void CanCar::Append(dbc::Sender<M>& sender, const M& message) {
  frames_.push_back(sender.Pack(dbc::Saturated(message)));
}

void CanCar::Begin(int64_t utime) {
  utime_ = utime;
  frames_.clear();
  if (time_sent_utime_ != 0 && SecondsBetween(time_sent_utime_, utime) < kTimePeriod) return;
  time_sent_utime_ = utime;
  Append(time_, {.time = static_cast<uint64_t>(utime / kSampleTimeMicros)});
  Append(tractive_system_, {.sample_time = ToSampleTime(utime),
                            .battery_voltage_v = kBatteryVoltage,
                            .dc_link_front_voltage_v = kBatteryVoltage,
                            .dc_link_rear_voltage_v = kBatteryVoltage});
}

void CanCar::Add(const imu_t& imu) {
  const uint16_t time = ToSampleTime(imu.utime);
  const double* a = imu.acceleration_mps2;
  const double* r = imu.angular_rate_radps;
  Append(acceleration_, {.sample_time = time, .x_mps2 = a[0], .y_mps2 = a[1], .z_mps2 = a[2]});
  Append(angular_rate_, {.sample_time = time, .x_radps = r[0], .y_radps = r[1], .z_radps = r[2]});
}

void CanCar::Add(const motors_t& motors) {
  const uint16_t time = ToSampleTime(motors.utime);
  const double* speed = motors.wheel_speed_radps;
  const double* torque = motors.wheel_torque_nm;
  Append(front_speeds_, {.sample_time = time, .left_radps = speed[0], .right_radps = speed[1]});
  Append(rear_speeds_, {.sample_time = time, .left_radps = speed[2], .right_radps = speed[3]});
  Append(front_torques_, Torques<dbc::MotorTorquesFront>(time, torque[0], torque[1]));
  Append(rear_torques_, Torques<dbc::MotorTorquesRear>(time, torque[2], torque[3]));
}

void CanCar::Add(const steering_t& steering) {
  Append(steering_, {.sample_time = ToSampleTime(steering.utime),
                     .angle_rad = steering.wheel_angle_rad,
                     .actuator_state = kActuatorActive});
}

void CanCar::Add(const ground_speed_t& ground_speed) {
  const double forward = ground_speed.velocity_mps[0];
  const double left = ground_speed.velocity_mps[1];
  Append(optical_,
         {.sample_time = ToSampleTime(ground_speed.utime),
          .forward_mps = forward,
          .left_mps = left,
          .quality_percent = Percent<uint8_t>(ground_speed.quality),
          .angle_deg = forward > kMinSlipSpeed ? kDegPerRad * std::atan2(left, forward) : 0.0});
}

void CanCar::Add(const vehicle_t& vehicle, double brake) {
  const uint16_t time = ToSampleTime(vehicle.utime);
  Append(res_, {.sample_time = time,
                .go = vehicle.res_go != 0,
                .stop = vehicle.res_stop != 0,
                .radio_quality_percent = 100});
  Append(brakes_, {.sample_time = time,
                   .front_pressure_bar = kFullPressure * brake,
                   .rear_pressure_bar = kFullPressure * brake,
                   .level_percent = 100.0 * brake,
                   .engaged = vehicle.brakes_engaged != 0,
                   .ok = vehicle.brakes_ok != 0});
  // Last: the computer puts the three together when it hears this one.
  Append(vehicle_, {.sample_time = time,
                    .mission = static_cast<uint8_t>(vehicle.mission),
                    .master_switch_on = vehicle.master_switch_on != 0,
                    .tractive_system_on = vehicle.tractive_system_on != 0,
                    .shutdown_circuit_closed = vehicle.shutdown_circuit_closed != 0,
                    .ebs_state = static_cast<uint8_t>(vehicle.ebs_state)});
}

void CanCar::Flush() {
  port_.Send(frames_);
  frames_.clear();
}

void CanCar::RepeatTime() {
  if (utime_ == 0) return;
  const CanFrame frame = time_.Pack({.time = static_cast<uint64_t>(utime_ / kSampleTimeMicros)});
  port_.Send({&frame, 1});
}

template <class M>
bool CanCar::Take(dbc::Receiver<M>& receiver, const CanFrame& frame, M& message) {
  const bool good = receiver.Unpack(frame, message).empty();
  CountRefusal(!good);
  return good;
}

void CanCar::Receive(Actuators& actuators, int64_t utime) {
  while (const auto received = port_.Receive()) TakeFrame(received->frame, actuators, utime);
  const int32_t state = actuators.state();
  const bool armed = state == as_state_t::STATE_READY || state == as_state_t::STATE_DRIVING;
  if (armed && SecondsBetween(heartbeat_utime_, utime) > kHeartbeatTimeout)
    actuators.OpenCircuit("the computer's heartbeat has ceased");
}

void CanCar::TakeFrame(const CanFrame& frame, Actuators& actuators, int64_t utime) {
  switch (frame.id) {
    case dbc::Heartbeat::kId: {
      dbc::Heartbeat message;
      if (!Take(heartbeat_in_, frame, message) || message.toggle == toggle_) return;
      toggle_ = message.toggle;
      heartbeat_utime_ = utime;
      return;
    }
    case dbc::AsStatus::kId: {
      dbc::AsStatus message;
      if (Take(status_in_, frame, message)) TakeStatus(message, actuators, utime);
      return;
    }
    case dbc::SteeringCommand::kId:
      Take(steering_in_, frame, steering_order_);
      return;
    case dbc::TorqueCommandFront::kId:
      Take(front_in_, frame, front_order_);
      return;
    case dbc::TorqueCommandRear::kId:
      Take(rear_in_, frame, rear_order_);
      return;
    case dbc::BrakeCommand::kId:
      break;
    default:
      return;  // the data logger's
  }
  if (!Take(brake_in_, frame, brake_order_)) return;
  const uint16_t time = brake_order_.command_time;
  const bool complete = steering_order_.command_time == time && front_order_.command_time == time &&
                        rear_order_.command_time == time;
  CountRefusal(!complete);
  if (!complete) return;
  drive_command_t command{};
  command.utime = FromSampleTime(time, utime);
  command.steering_angle_rad = steering_order_.angle_rad;
  const double torques[] = {front_order_.left_nm, front_order_.right_nm, rear_order_.left_nm,
                            rear_order_.right_nm};
  std::copy(std::begin(torques), std::end(torques), command.wheel_torque_nm);
  command.brake = 0.01 * brake_order_.level_percent;
  if (command.utime == command_utime_) return;  // held: the deadman's to judge
  CountRefusal(!actuators.OnCommand(command, utime).empty());
}

void CanCar::TakeStatus(const dbc::AsStatus& status, Actuators& actuators, int64_t utime) {
  command_utime_ = FromSampleTime(status.command_time, utime);
  if (status.as_state == as_state_t::STATE_UNKNOWN) return;  // nobody has told the computer yet
  state_utime_ = FromSampleTime(status.state_time, utime);
  as_state_t state{};
  state.utime = state_utime_;
  state.state = status.as_state;
  state.mission_finished = status.mission_finished;
  state.reason = "as the CAN bus says";
  CountRefusal(!actuators.OnState(state, utime).empty());
}

}  // namespace hairpin
