#pragma once

#include <cstdint>
#include <vector>

#include "common/can/can_port.hpp"
#include "common/can/dbc.hpp"
#include "common/car.hpp"
#include "hairpin/ground_speed_t.hpp"
#include "hairpin/imu_t.hpp"
#include "hairpin/motors_t.hpp"
#include "hairpin/steering_t.hpp"
#include "hairpin/vehicle_t.hpp"
#include "tools/simulator/actuators.hpp"

namespace hairpin {

/// The control units of the simulated car as CAN shows them, by config/hairpin.dbc: measurements
/// go out as frames, orders come in and reach the actuators. Opens the shutdown circuit when the
/// computer's heartbeat ceases while it is armed.
class CanCar {
 public:
  static constexpr double kHeartbeatTimeout = 0.2;  // s, of the shutdown circuit
  static constexpr double kFullPressure = 100.0;    // bar

  /// `port` must outlive this.
  explicit CanCar(CanPort& port) : port_(port) {}

  /// Begins the frames of one tick.
  void Begin(int64_t utime);
  /// Values beyond the end of a signal's scale are sent as that end.
  void Add(const imu_t& imu);
  void Add(const motors_t& motors);
  void Add(const steering_t& steering);
  void Add(const ground_speed_t& ground_speed);
  /// VEHICLE_STATUS, RES_STATUS and BRAKES; `brake`: 0 to 1 of full pressure.
  void Add(const vehicle_t& vehicle, double brake);
  /// Sends what was added since Begin().
  void Flush();
  /// Sends the time of Begin() again: frames flow, though simulated time waits.
  void RepeatTime();

  /// Takes what the computer has sent until now; `utime` is the car's time. Frames that are wrong,
  /// and orders that the actuators refuse, are counted.
  void Receive(Actuators& actuators, int64_t utime);

  /// Car time of the newest command and of the newest state that were answered; 0: none.
  int64_t command_utime() const { return command_utime_; }
  int64_t state_utime() const { return state_utime_; }
  int64_t refused() const { return refused_; }
  /// Times of changes of the heartbeat's toggle, the newest; 0: none yet.
  int64_t heartbeat_utime() const { return heartbeat_utime_; }

 private:
  template <class M>
  void Append(dbc::Sender<M>& sender, const M& message);
  template <class M>
  bool Take(dbc::Receiver<M>& receiver, const CanFrame& frame, M& message);
  void TakeFrame(const CanFrame& frame, Actuators& actuators, int64_t utime);
  void TakeStatus(const dbc::AsStatus& status, Actuators& actuators, int64_t utime);
  void CountRefusal(bool refused) { refused_ += refused ? 1 : 0; }

  CanPort& port_;
  std::vector<CanFrame> frames_;
  int64_t utime_ = 0;
  int64_t time_sent_utime_ = 0;
  int64_t command_utime_ = 0;
  int64_t state_utime_ = 0;
  int64_t heartbeat_utime_ = 0;
  bool toggle_ = false;
  int64_t refused_ = 0;

  dbc::Sender<dbc::CarTime> time_;
  dbc::Sender<dbc::VehicleStatus> vehicle_;
  dbc::Sender<dbc::ResStatus> res_;
  dbc::Sender<dbc::Brakes> brakes_;
  dbc::Sender<dbc::TractiveSystem> tractive_system_;
  dbc::Sender<dbc::ImuAcceleration> acceleration_;
  dbc::Sender<dbc::ImuAngularRate> angular_rate_;
  dbc::Sender<dbc::OpticalSpeed> optical_;
  dbc::Sender<dbc::WheelSpeedsFront> front_speeds_;
  dbc::Sender<dbc::WheelSpeedsRear> rear_speeds_;
  dbc::Sender<dbc::MotorTorquesFront> front_torques_;
  dbc::Sender<dbc::MotorTorquesRear> rear_torques_;
  dbc::Sender<dbc::SteeringAngle> steering_;

  dbc::Receiver<dbc::Heartbeat> heartbeat_in_;
  dbc::Receiver<dbc::AsStatus> status_in_;
  dbc::Receiver<dbc::SteeringCommand> steering_in_;
  dbc::Receiver<dbc::TorqueCommandFront> front_in_;
  dbc::Receiver<dbc::TorqueCommandRear> rear_in_;
  dbc::Receiver<dbc::BrakeCommand> brake_in_;
  // The newest of each; a command is theirs together once all have its time.
  dbc::SteeringCommand steering_order_;
  dbc::TorqueCommandFront front_order_;
  dbc::TorqueCommandRear rear_order_;
  dbc::BrakeCommand brake_order_;
};

}  // namespace hairpin
