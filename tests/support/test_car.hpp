#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/can/can_port.hpp"
#include "common/can/dbc.hpp"
#include "common/can/sample_time.hpp"

namespace hairpin {

/// The control units of a car on the CAN bus, for tests: send its state each tick of 10 ms, do what
/// they are told, and keep what they heard. It rolls at 20 rad/s whatever happens.
class TestCar {
 public:
  /// What the car sends in tick number `tick`, at car time `now`.
  std::vector<CanFrame> Frames(int64_t now, int tick) {
    const uint16_t time = ToSampleTime(now);
    std::vector<CanFrame> sent{
        time_.Pack({.time = static_cast<uint64_t>(now / kSampleTimeMicros)})};
    if (tick % 5 == 0) {
      if (res_talks) sent.push_back(NextRes(now));
      sent.push_back(brakes_.Pack({.sample_time = time,
                                   .level_percent = brake_share * brake.level_percent,
                                   .engaged = brake.level_percent > 20.0,
                                   .ok = true}));
      sent.push_back(vehicle_.Pack({.sample_time = time,
                                    .mission = 6,
                                    .master_switch_on = true,
                                    .tractive_system_on = true,
                                    .shutdown_circuit_closed = true,
                                    .ebs_state = 2}));
    }
    if (wheels_talk) AppendWheels(time, sent);
    if (!steering_stuck) Steer();
    sent.push_back(steering_.Pack({.sample_time = time, .angle_rad = angle_}));
    sent.push_back(dbc::Pack(dbc::OpticalSpeed{.sample_time = time, .forward_mps = 4.6}));
    sent.push_back(
        dbc::Pack(dbc::ImuAcceleration{.sample_time = time, .x_mps2 = 1.0, .z_mps2 = 0.5}));
    sent.push_back(dbc::Pack(dbc::ImuAngularRate{.sample_time = time, .z_radps = 0.3}));
    return sent;
  }
  /// The next good RES_STATUS, for a test to spoil.
  CanFrame NextRes(int64_t now) {
    return res_.Pack({.sample_time = ToSampleTime(now), .go = true});
  }

  /// Begins to listen anew: `heartbeat` and `frames` are of what comes from here on.
  void Listen() {
    heartbeat = false;
    frames = 0;
  }
  /// Throws std::logic_error for a bad frame. After frames were lost, `strict` is to be false.
  void Hear(const CanFrame& frame, bool strict = true) {
    ++frames;
    dbc::Heartbeat beat;
    std::string problem;
    if (frame.id == dbc::SteeringCommand::kId) problem = steering_in_.Unpack(frame, steering);
    if (frame.id == dbc::TorqueCommandFront::kId) problem = front_in_.Unpack(frame, front);
    if (frame.id == dbc::BrakeCommand::kId) problem = brake_in_.Unpack(frame, brake);
    if (frame.id == dbc::AsStatus::kId) problem = status_in_.Unpack(frame, status);
    if (frame.id == dbc::Heartbeat::kId) {
      problem = heartbeat_in_.Unpack(frame, beat);
      heartbeat = heartbeat || beat.toggle != toggle_;
      toggle_ = beat.toggle;
    }
    if (frame.id >= dbc::DvDrivingDynamics1::kId) logger.push_back(frame);
    if (strict && !problem.empty())
      throw std::logic_error("the gateway sends a bad frame: " + problem);
  }

  bool wheels_talk = true;
  bool res_talks = true;
  bool steering_stuck = false;
  double extra_torque = 0.0;
  double brake_share = 1.0;  // of what was asked for that acts

  // What was heard last.
  dbc::SteeringCommand steering;
  dbc::TorqueCommandFront front;
  dbc::BrakeCommand brake;
  dbc::AsStatus status;
  bool heartbeat = false;
  int frames = 0;
  std::vector<CanFrame> logger;

 private:
  void AppendWheels(uint16_t time, std::vector<CanFrame>& frames_out) {
    const double torque = front.left_nm + extra_torque;
    frames_out.push_back(
        front_speeds_.Pack({.sample_time = time, .left_radps = 20.0, .right_radps = 20.0}));
    frames_out.push_back(
        rear_speeds_.Pack({.sample_time = time, .left_radps = 20.0, .right_radps = 20.0}));
    frames_out.push_back(dbc::Pack(dbc::MotorTorquesFront{
        .sample_time = time, .left_torque_nm = torque, .right_torque_nm = torque}));
    frames_out.push_back(dbc::Pack(dbc::MotorTorquesRear{
        .sample_time = time, .left_torque_nm = torque, .right_torque_nm = torque}));
  }
  // As the shipped model of the actuator expects: 30 ms late, 1.8 rad/s.
  void Steer() {
    delayed_.push_back(steering.angle_rad);
    if (delayed_.size() > 3) delayed_.erase(delayed_.begin());
    angle_ += std::clamp(delayed_.front() - angle_, -0.018, 0.018);
  }

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
