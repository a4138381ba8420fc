#include "daemons/can_gateway/frame_decoder.hpp"

#include <algorithm>
#include <cmath>

#include "common/can/sample_time.hpp"
#include "common/clock.hpp"

namespace hairpin {
namespace {

double PeriodSeconds(int period_ms) { return 1e-3 * period_ms; }

}  // namespace

std::optional<Measurement> FrameDecoder::Take(const ReceivedFrame& frame) {
  clock_.Heard(frame.arrival_micros);
  switch (frame.frame.id) {
    case dbc::CarTime::kId:
      TakeTime(frame);
      return std::nullopt;
    case dbc::VehicleStatus::kId:
      if (!Receive(frame, vehicle_)) return std::nullopt;
      return Vehicle();
    case dbc::ResStatus::kId:
      Receive(frame, res_);
      return std::nullopt;
    case dbc::Brakes::kId:
      if (!Receive(frame, brakes_)) return std::nullopt;
      return BrakeSample{brakes_.utime, 0.01 * brakes_.message.level_percent};
    case dbc::ImuAcceleration::kId:
      return Receive(frame, acceleration_) ? Imu() : std::nullopt;
    case dbc::ImuAngularRate::kId:
      return Receive(frame, angular_rate_) ? Imu() : std::nullopt;
    case dbc::OpticalSpeed::kId:
      return Receive(frame, optical_) ? GroundSpeed() : std::nullopt;
    case dbc::WheelSpeedsFront::kId:
      return Receive(frame, front_speeds_) ? Motors() : std::nullopt;
    case dbc::WheelSpeedsRear::kId:
      return Receive(frame, rear_speeds_) ? Motors() : std::nullopt;
    case dbc::MotorTorquesFront::kId:
      return Receive(frame, front_torques_) ? Motors() : std::nullopt;
    case dbc::MotorTorquesRear::kId:
      return Receive(frame, rear_torques_) ? Motors() : std::nullopt;
    case dbc::SteeringAngle::kId:
      if (!Receive(frame, steering_)) return std::nullopt;
      return SteeringSample{steering_.utime, steering_.message.angle_rad};
    case dbc::TractiveSystem::kId:
      Receive(frame, tractive_system_);
      return std::nullopt;
    default:
      Refuse("another frame", "not in the database");
      return std::nullopt;
  }
}

void FrameDecoder::TakeTime(const ReceivedFrame& frame) {
  dbc::CarTime message;
  std::string problem = time_.Unpack(frame.frame, message);
  if (problem.empty()) {
    const auto utime = static_cast<int64_t>(message.time) * kSampleTimeMicros;
    problem = clock_.SetTime(utime, frame.arrival_micros);
  }
  if (!problem.empty()) Refuse(dbc::CarTime::kName, problem);
}

template <class M>
bool FrameDecoder::Receive(const ReceivedFrame& frame, Slot<M>& slot) {
  if (slot.epoch != clock_.epoch()) slot.utime = 0;
  slot.epoch = clock_.epoch();
  M message;
  std::string problem = slot.receiver.Unpack(frame.frame, message);
  std::optional<int64_t> utime;
  if (problem.empty()) {
    utime = clock_.Unwrap(message.sample_time);
    if (!utime) problem = "sample time far from the car's";
    if (utime && *utime <= slot.utime) problem = "sample time does not advance";
  }
  if (!problem.empty()) {
    Refuse(M::kName, problem);
    return false;
  }
  slot.message = message;
  slot.utime = *utime;
  if (M::kProtected) clock_.Advance(*utime, frame.arrival_micros);
  return true;
}

void FrameDecoder::Refuse(const char* frame, const std::string& problem) {
  last_refusal_ = std::string(frame) + ": " + problem;
  ++refusals_[last_refusal_];
  ++refused_;
}

std::optional<Measurement> FrameDecoder::Imu() {
  if (acceleration_.utime != angular_rate_.utime) return std::nullopt;
  const auto& a = acceleration_.message;
  const auto& r = angular_rate_.message;
  return ImuSample{
      acceleration_.utime, {a.x_mps2, a.y_mps2, a.z_mps2}, {r.x_radps, r.y_radps, r.z_radps}};
}

std::optional<Measurement> FrameDecoder::Motors() {
  const int64_t utime = front_speeds_.utime;
  if (rear_speeds_.utime != utime || front_torques_.utime != utime || rear_torques_.utime != utime)
    return std::nullopt;
  const auto& front = front_torques_.message;
  const auto& rear = rear_torques_.message;
  return MotorsSample{
      utime,
      {front_speeds_.message.left_radps, front_speeds_.message.right_radps,
       rear_speeds_.message.left_radps, rear_speeds_.message.right_radps},
      {front.left_torque_nm, front.right_torque_nm, rear.left_torque_nm, rear.right_torque_nm}};
}

std::optional<Measurement> FrameDecoder::GroundSpeed() const {
  const auto& m = optical_.message;
  return GroundSpeedSample{optical_.utime, {m.forward_mps, m.left_mps}, 0.01 * m.quality_percent};
}

template <class M>
bool FrameDecoder::IsFresh(const Slot<M>& slot, int64_t now) const {
  return slot.utime > 0 && slot.epoch == clock_.epoch() &&
         SecondsBetween(slot.utime, now) <= kStatePeriods * PeriodSeconds(M::kPeriodMs);
}

Measurement FrameDecoder::Vehicle() const {
  VehicleSample sample;
  sample.utime = vehicle_.utime;
  sample.mission = vehicle_.message.mission;
  sample.master_switch_on = vehicle_.message.master_switch_on;
  sample.tractive_system_on = vehicle_.message.tractive_system_on;
  sample.shutdown_circuit_closed = vehicle_.message.shutdown_circuit_closed;
  sample.ebs_state = vehicle_.message.ebs_state;
  // Silence is no permission: a RES that is lost has stopped the car [FAULTS 38].
  const bool res = IsFresh(res_, sample.utime);
  sample.res_go = res && res_.message.go;
  sample.res_stop = !res || res_.message.stop;
  const bool brakes = IsFresh(brakes_, sample.utime);
  sample.brakes_engaged = brakes && brakes_.message.engaged;
  sample.brakes_ok = brakes && brakes_.message.ok;
  // The last speeds known, if they are lost: no standstill by silence.
  const double speeds[] = {front_speeds_.message.left_radps, front_speeds_.message.right_radps,
                           rear_speeds_.message.left_radps, rear_speeds_.message.right_radps};
  for (const double speed : speeds) sample.speed += 0.25 * std::abs(speed) * wheel_radius_;
  return sample;
}

std::string FrameDecoder::LostState(int64_t now) const {
  const auto lost = [&]<class M>(const Slot<M>& slot) {
    return slot.utime > 0 && !IsFresh(slot, now);
  };
  if (lost(vehicle_)) return dbc::VehicleStatus::kName;
  if (lost(res_)) return dbc::ResStatus::kName;
  return lost(brakes_) ? dbc::Brakes::kName : "";
}

int64_t FrameDecoder::wheel_speeds_utime() const {
  return std::min(front_speeds_.utime, rear_speeds_.utime);
}

}  // namespace hairpin
