#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/can/can_port.hpp"
#include "common/can/dbc.hpp"
#include "daemons/can_gateway/actuator_monitor.hpp"
#include "daemons/can_gateway/command_limiter.hpp"
#include "daemons/can_gateway/data_logger.hpp"
#include "daemons/can_gateway/frame_decoder.hpp"
#include "daemons/can_gateway/supervision.hpp"

namespace hairpin {

struct CanGatewayParams {
  double wheel_radius = 0.0;  // [m], > 0
  CommandLimits limits;
  SupervisionParams supervision;
  ActuatorMonitorParams monitor;
  double stop_brake = 0.0;     // 0 to 1, where commands are missing or actuators disagree
  double parking_brake = 0.0;  // 0 to 1, where the car is to stand
};

/// Between the CAN bus and the rest: frames in with the time of their arrival, measurements out;
/// commands in, frames out, and with them the heartbeat on which the shutdown circuit hangs.
///
/// A command passes only while AS_STATE says Driving, limited in value and rate, and only as long
/// as it is fresh: held for `hold_after`, then no torque and brakes, then the heartbeat ceases
/// [FAULTS, the CAN deadman]. Times are car time; `wall` is a monotonic clock in microseconds,
/// which counts where the bus is silent.
class CanGateway {
 public:
  static constexpr double kMissedCycle = 0.02;  // s without a command, then orders repeat ...
  static constexpr double kRepeatCycle = 0.01;  // ... each 10 ms
  static constexpr double kLoggerPeriod = 0.1;  // s

  /// Throws std::invalid_argument for parameters out of bounds.
  explicit CanGateway(const CanGatewayParams& params);

  std::optional<Measurement> OnFrame(const ReceivedFrame& frame);
  /// Each returns why it was refused, empty if it was not.
  std::string OnCommand(const Command& command, int64_t wall);
  std::string OnAsReport(const AsReport& report, int64_t wall);
  std::string OnSupervisor(const SupervisorReport& report, int64_t wall);
  void OnCones(int local, int global);
  void OnBus(CanState state) { bus_ = state; }

  /// Frames that are due now; to be called after each of the above, and each 10 ms.
  std::vector<CanFrame> Due(int64_t wall);
  /// The last frames before this daemon ends: neutral, without a heartbeat.
  std::vector<CanFrame> Farewell(int64_t wall);

  const FrameDecoder& decoder() const { return decoder_; }
  const Supervision& supervision() const { return supervision_; }
  const CommandLimiter& limiter() const { return limiter_; }

 private:
  int64_t Now(int64_t wall) const { return decoder_.clock().Now(wall); }
  void Judge(int64_t wall);
  bool CycleIsDue(int64_t now) const;
  DriveOrder Order() const;
  int64_t CommandTime(int64_t now) const;
  void AppendOrders(int64_t now, std::vector<CanFrame>& frames);
  void AppendStatus(int64_t now, std::vector<CanFrame>& frames);
  void AppendLogger(int64_t now, std::vector<CanFrame>& frames);

  CanGatewayParams params_;
  FrameDecoder decoder_;
  Supervision supervision_;
  CommandLimiter limiter_;
  ActuatorMonitor monitor_;
  CanState bus_ = CanState::kActive;
  LoggerInput logger_;
  DriveOrder order_;           // of the last command, limited
  int64_t command_utime_ = 0;  // of the last command
  bool cycle_due_ = false;
  bool status_due_ = false;
  bool repeating_ = false;  // the last cycle was not caused by a command
  int64_t cycle_utime_ = 0;
  int64_t logger_cell_ = 0;
  DeadmanStage sent_stage_ = DeadmanStage::kFresh;
  bool toggle_ = false;
  dbc::Sender<dbc::Heartbeat> heartbeat_;
  dbc::Sender<dbc::AsStatus> as_status_;
  dbc::Sender<dbc::SteeringCommand> steering_;
  dbc::Sender<dbc::TorqueCommandFront> front_;
  dbc::Sender<dbc::TorqueCommandRear> rear_;
  dbc::Sender<dbc::BrakeCommand> brake_;
};

}  // namespace hairpin
