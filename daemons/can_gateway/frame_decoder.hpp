#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/can/can_port.hpp"
#include "common/can/dbc.hpp"
#include "daemons/can_gateway/car_clock.hpp"
#include "daemons/can_gateway/measurements.hpp"

namespace hairpin {

/// Frames of the car in, measurements out. A frame of wrong length, value out of range, wrong
/// counter, checksum or sample time is refused, counted and named [FAULTS 30]. Frames of one
/// measurement are put together by their sample time.
class FrameDecoder {
 public:
  static constexpr double kStatePeriods = 3.0;  // by then a state is lost [FAULTS 30]

  /// `wheel_radius` [m].
  explicit FrameDecoder(double wheel_radius) : wheel_radius_(wheel_radius) {}

  /// The measurement that this frame completes, if it does.
  std::optional<Measurement> Take(const ReceivedFrame& frame);

  const CarClock& clock() const { return clock_; }
  /// Name of a state of the car (VEHICLE_STATUS, RES_STATUS, BRAKES) that was heard, and of which
  /// the last good frame is more than three periods older than `now`; empty if none is.
  std::string LostState(int64_t now) const;
  /// Time of the last good wheel speeds of both axles, 0: none.
  int64_t wheel_speeds_utime() const;
  /// By "FRAME: problem".
  const std::map<std::string, int64_t>& refusals() const { return refusals_; }
  /// The last entry of refusals(), for a warning.
  const std::string& last_refusal() const { return last_refusal_; }
  int64_t refused() const { return refused_; }

 private:
  template <class M>
  struct Slot {
    dbc::Receiver<M> receiver;
    M message;
    int64_t utime = 0;  // of the last good one; 0: none in this epoch
    int epoch = 0;
  };

  template <class M>
  bool Receive(const ReceivedFrame& frame, Slot<M>& slot);
  void Refuse(const char* frame, const std::string& problem);
  void TakeTime(const ReceivedFrame& frame);
  std::optional<Measurement> Imu();
  std::optional<Measurement> Motors();
  std::optional<Measurement> GroundSpeed() const;
  Measurement Vehicle() const;
  template <class M>
  bool IsFresh(const Slot<M>& slot, int64_t now) const;

  double wheel_radius_;
  CarClock clock_;
  dbc::Receiver<dbc::CarTime> time_;
  Slot<dbc::VehicleStatus> vehicle_;
  Slot<dbc::ResStatus> res_;
  Slot<dbc::Brakes> brakes_;
  Slot<dbc::ImuAcceleration> acceleration_;
  Slot<dbc::ImuAngularRate> angular_rate_;
  Slot<dbc::OpticalSpeed> optical_;
  Slot<dbc::WheelSpeedsFront> front_speeds_;
  Slot<dbc::WheelSpeedsRear> rear_speeds_;
  Slot<dbc::MotorTorquesFront> front_torques_;
  Slot<dbc::MotorTorquesRear> rear_torques_;
  Slot<dbc::SteeringAngle> steering_;
  Slot<dbc::TractiveSystem> tractive_system_;
  std::map<std::string, int64_t> refusals_;
  std::string last_refusal_;
  int64_t refused_ = 0;
};

}  // namespace hairpin
