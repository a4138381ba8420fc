#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "common/can/sample_time.hpp"
#include "common/config.hpp"
#include "daemons/can_gateway/can_gateway.hpp"
#include "daemons/can_gateway/can_gateway_node.hpp"
#include "hairpin/as_state_t.hpp"

namespace hairpin {

inline CanGatewayParams ShippedCanGatewayParams() {
  return LoadCanGatewayConfig(
             Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "can_gateway"))
      .gateway;
}

/// A car on the other end of the gateway's frames: sends its state each tick of 10 ms, does what it
/// is told at once, and keeps what it heard.
class GatewayRig {
 public:
  static constexpr int64_t kStart = 1'700'000'000'000'000;
  static constexpr int64_t kTick = 10'000;

  GatewayRig() : gateway(ShippedCanGatewayParams()) {}

  /// One tick: frames of the car, and of those who supervise.
  void Tick() {
    ++ticks_;
    if (car_time_runs) now += kTick;
    wall += kTick;
    if (car_talks) TalkOfTheCar();
    if (watchdog_lives) gateway.OnSupervisor({now, stop_asked, emergency_asked}, wall);
    if (mission_manager_lives && (ticks_ % 5 == 0 || state != said_state_)) SayState();
    if (commands_flow) {
      refusal = gateway.OnCommand({now, moves, command, 5.0}, wall);
    }
    Hear(gateway.Due(wall));
  }
  void Run(int ticks) {
    for (int i = 0; i < ticks; ++i) Tick();
  }
  /// Ready for a second, then Driving.
  void Drive() {
    state = as_state_t::STATE_READY;
    moves = false;
    Run(100);
    state = as_state_t::STATE_DRIVING;
    moves = true;
    Run(30);
  }
  /// Ticks until `done`, at most 100; -1 if it does not come to be.
  template <class Done>
  int TicksUntil(Done done) {
    for (int i = 0; i <= 100; ++i) {
      if (done()) return i;
      Tick();
    }
    return -1;
  }
  void Send(const CanFrame& frame) {
    const auto measurement = gateway.OnFrame({frame, wall});
    if (measurement) measurements.push_back(*measurement);
  }
  /// The next good RES_STATUS, for a test to spoil.
  CanFrame NextRes() { return res_.Pack({.sample_time = ToSampleTime(now), .go = true}); }
  int64_t Refused(const std::string& what) const {
    const auto found = gateway.decoder().refusals().find(what);
    return found == gateway.decoder().refusals().end() ? 0 : found->second;
  }

  CanGateway gateway;
  int64_t now = kStart;
  int64_t wall = 5'000'000;
  bool car_talks = true;
  bool car_time_runs = true;
  bool wheels_talk = true;
  bool res_talks = true;
  bool steering_stuck = false;
  double extra_torque = 0.0;
  double brake_share = 1.0;  // of what was asked for that acts
  bool watchdog_lives = true;
  bool mission_manager_lives = true;
  bool commands_flow = true;
  bool stop_asked = false;
  bool emergency_asked = false;
  int state = as_state_t::STATE_OFF;
  bool moves = false;
  DriveOrder command{0.1, {20.0, 20.0, 20.0, 20.0}, 0.0};
  std::string refusal;

  // What the car heard last, and in this tick.
  dbc::SteeringCommand steering;
  dbc::TorqueCommandFront front;
  dbc::BrakeCommand brake;
  dbc::AsStatus status;
  bool heartbeat = false;  // in the last tick
  int frames = 0;          // in the last tick
  std::vector<CanFrame> logger;
  std::vector<Measurement> measurements;

 private:
  void SayState() {
    said_state_ = state;
    gateway.OnAsReport({now, state, 6, 2, false}, wall);
  }
  void TalkOfTheCar() {
    const uint16_t time = ToSampleTime(now);
    Send(time_.Pack({.time = static_cast<uint64_t>(now / kSampleTimeMicros)}));
    if (ticks_ % 5 == 0) {
      if (res_talks) Send(NextRes());
      Send(brakes_.Pack({.sample_time = time,
                         .level_percent = brake_share * brake.level_percent,
                         .engaged = brake.level_percent > 20.0,
                         .ok = true}));
      Send(vehicle_.Pack({.sample_time = time,
                          .mission = 6,
                          .master_switch_on = true,
                          .tractive_system_on = true,
                          .shutdown_circuit_closed = true,
                          .ebs_state = 2}));
    }
    if (wheels_talk) {
      Send(front_speeds_.Pack({.sample_time = time, .left_radps = 20.0, .right_radps = 20.0}));
      Send(rear_speeds_.Pack({.sample_time = time, .left_radps = 20.0, .right_radps = 20.0}));
      const double torque = front.left_nm + extra_torque;
      Send(dbc::Pack(dbc::MotorTorquesFront{
          .sample_time = time, .left_torque_nm = torque, .right_torque_nm = torque}));
      Send(dbc::Pack(dbc::MotorTorquesRear{
          .sample_time = time, .left_torque_nm = torque, .right_torque_nm = torque}));
    }
    if (!steering_stuck) Steer();
    Send(steering_.Pack({.sample_time = time, .angle_rad = angle_}));
    Send(dbc::Pack(dbc::OpticalSpeed{.sample_time = time, .forward_mps = 4.6}));
    Send(dbc::Pack(dbc::ImuAcceleration{.sample_time = time, .x_mps2 = 1.0, .z_mps2 = 0.5}));
    Send(dbc::Pack(dbc::ImuAngularRate{.sample_time = time, .z_radps = 0.3}));
  }
  // As the shipped model of the actuator expects: 30 ms late, 1.8 rad/s.
  void Steer() {
    delayed_.push_back(steering.angle_rad);
    if (delayed_.size() > 3) delayed_.erase(delayed_.begin());
    angle_ += std::clamp(delayed_.front() - angle_, -0.018, 0.018);
  }
  void Hear(const std::vector<CanFrame>& due) {
    heartbeat = false;
    frames = static_cast<int>(due.size());
    for (const CanFrame& frame : due) {
      dbc::Heartbeat beat;
      std::string problem;
      if (frame.id == dbc::SteeringCommand::kId) problem = steering_in_.Unpack(frame, steering);
      if (frame.id == dbc::TorqueCommandFront::kId) problem = front_in_.Unpack(frame, front);
      if (frame.id == dbc::BrakeCommand::kId) problem = brake_in_.Unpack(frame, brake);
      if (frame.id == dbc::AsStatus::kId) problem = status_in_.Unpack(frame, status);
      if (frame.id == dbc::Heartbeat::kId) {
        problem = heartbeat_in_.Unpack(frame, beat);
        heartbeat = beat.toggle != toggle_;
        toggle_ = beat.toggle;
      }
      if (frame.id >= dbc::DvDrivingDynamics1::kId) logger.push_back(frame);
      if (!problem.empty()) throw std::logic_error("the gateway sends a bad frame: " + problem);
    }
  }

  int ticks_ = -1;
  int said_state_ = -1;
  double angle_ = 0.0;
  bool toggle_ = false;
  std::vector<double> delayed_;
  dbc::Sender<dbc::CarTime> time_;
  dbc::Sender<dbc::VehicleStatus> vehicle_;
  dbc::Sender<dbc::ResStatus> res_;
  dbc::Sender<dbc::Brakes> brakes_;
  dbc::Sender<dbc::WheelSpeedsFront> front_speeds_;
  dbc::Sender<dbc::WheelSpeedsRear> rear_speeds_;
  dbc::Sender<dbc::SteeringAngle> steering_;
  dbc::Receiver<dbc::SteeringCommand> steering_in_;
  dbc::Receiver<dbc::TorqueCommandFront> front_in_;
  dbc::Receiver<dbc::BrakeCommand> brake_in_;
  dbc::Receiver<dbc::AsStatus> status_in_;
  dbc::Receiver<dbc::Heartbeat> heartbeat_in_;
};

}  // namespace hairpin
