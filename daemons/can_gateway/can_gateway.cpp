#include "daemons/can_gateway/can_gateway.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/can/sample_time.hpp"
#include "common/clock.hpp"
#include "hairpin/as_state_t.hpp"

namespace hairpin {
namespace {

constexpr double kMaxAhead = 0.2;      // s, of a command before what the bus has told
constexpr double kMaxRateTime = 0.05;  // s: a gap in the commands gives no larger step
constexpr double kFullBrake = 1.0;

bool IsFinite(const DriveOrder& order) {
  return std::isfinite(order.steering_angle) && std::isfinite(order.brake) &&
         std::all_of(order.wheel_torque.begin(), order.wheel_torque.end(),
                     [](double torque) { return std::isfinite(torque); });
}

}  // namespace

CanGateway::CanGateway(const CanGatewayParams& params)
    : params_(params),
      decoder_(params.wheel_radius),
      supervision_(params.supervision),
      limiter_(params.limits),
      monitor_(params.monitor) {
  const auto share = [](double value) { return value >= 0.0 && value <= 1.0; };
  if (!(params.wheel_radius > 0.0) || !share(params.stop_brake) || !share(params.parking_brake))
    throw std::invalid_argument("CAN gateway: a parameter is out of bounds");
  logger_.max_wheel_torque = params.limits.max_wheel_torque;
}

std::optional<Measurement> CanGateway::OnFrame(const ReceivedFrame& frame) {
  std::optional<Measurement> measurement = decoder_.Take(frame);
  if (!measurement) return std::nullopt;
  if (const auto* imu = std::get_if<ImuSample>(&*measurement)) logger_.imu = *imu;
  if (const auto* vehicle = std::get_if<VehicleSample>(&*measurement)) logger_.vehicle = *vehicle;
  if (const auto* motors = std::get_if<MotorsSample>(&*measurement)) {
    logger_.motors = *motors;
    monitor_.Measured(*motors);
  }
  if (const auto* steering = std::get_if<SteeringSample>(&*measurement)) {
    logger_.steering = *steering;
    monitor_.Measured(*steering);
  }
  if (const auto* brake = std::get_if<BrakeSample>(&*measurement)) {
    logger_.brake = *brake;
    monitor_.Measured(*brake);
  }
  return measurement;
}

std::string CanGateway::OnCommand(const Command& command, int64_t wall) {
  const int64_t now = Now(wall);
  if (now == 0) return "the bus has told no time yet";
  if (!IsFinite(command.order)) return "a value is not finite";
  if (command.utime <= command_utime_) return "its time does not rise";
  if (SecondsBetween(now, command.utime) > kMaxAhead) return "its time lies in the future";
  if (SecondsBetween(command.utime, now) > params_.supervision.deadman.neutral_after)
    return "too old";
  if (!supervision_.driving() && command.asks_to_move) return "AS is not Driving";
  const double age = SecondsBetween(command_utime_, command.utime);
  command_utime_ = command.utime;
  cycle_due_ = true;
  if (!supervision_.driving()) return {};
  order_ =
      limiter_.Limit(command.order, std::min(age, kMaxRateTime), supervision_.controlled_stop());
  logger_.target_speed = command.target_speed;
  supervision_.HearCommand(command.utime);
  return {};
}

std::string CanGateway::OnAsReport(const AsReport& report, int64_t wall) {
  const bool drove = supervision_.driving();
  const int state = supervision_.as().state;
  std::string problem = supervision_.Hear(report, Now(wall));
  if (!problem.empty()) return problem;
  logger_.as = report;
  status_due_ = true;
  if (report.state != state) cycle_due_ = true;
  if (supervision_.driving() && !drove) {
    // The car stands, and brakes: from there the limits lead on.
    order_ = {logger_.steering.angle, {}, params_.parking_brake};
    limiter_.Reset(order_);
    monitor_.Reset(report.utime);
  }
  return {};
}

std::string CanGateway::OnSupervisor(const SupervisorReport& report, int64_t wall) {
  return supervision_.Hear(report, Now(wall));
}

void CanGateway::OnCones(int local, int global) {
  logger_.cones = local;
  logger_.cones_all = global;
}

void CanGateway::Judge(int64_t wall) {
  CarSituation input;
  input.now = Now(wall);
  input.bus_silence = decoder_.clock().Silence(wall);
  input.bus = bus_;
  input.wheel_speeds_utime = decoder_.wheel_speeds_utime();
  input.lost_state = decoder_.LostState(input.now);
  if (supervision_.driving()) input.actuators = monitor_.Judge(input.now);
  input.culprit = monitor_.culprit();
  supervision_.Judge(input);
}

bool CanGateway::CycleIsDue(int64_t now) const {
  if (cycle_due_ || supervision_.stage() != sent_stage_) return true;
  return SecondsBetween(cycle_utime_, now) >= (repeating_ ? kRepeatCycle : kMissedCycle);
}

std::vector<CanFrame> CanGateway::Due(int64_t wall) {
  std::vector<CanFrame> frames;
  const int64_t now = Now(wall);
  if (now == 0) return frames;  // nobody is there
  Judge(wall);
  if (CycleIsDue(now)) {
    repeating_ = !cycle_due_;
    AppendOrders(now, frames);
    status_due_ = true;
  }
  if (status_due_) AppendStatus(now, frames);
  AppendLogger(now, frames);
  cycle_due_ = status_due_ = false;
  return frames;
}

DriveOrder CanGateway::Order() const {
  DriveOrder order = order_;
  if (supervision_.manual()) return {logger_.steering.angle, {}, 0.0};
  if (!supervision_.driving() && supervision_.emergency().empty())
    return {logger_.steering.angle, {}, params_.parking_brake};
  if (supervision_.emergency().empty() && supervision_.stop().empty()) return order;
  order.wheel_torque.fill(0.0);
  order.brake =
      supervision_.emergency().empty() ? std::max(order.brake, params_.stop_brake) : kFullBrake;
  return order;
}

// A held order keeps the time of its command; one of our own is true now.
int64_t CanGateway::CommandTime(int64_t now) const {
  const bool own =
      !supervision_.driving() || !supervision_.stop().empty() || !supervision_.emergency().empty();
  return own ? now : command_utime_;
}

void CanGateway::AppendOrders(int64_t now, std::vector<CanFrame>& frames) {
  cycle_utime_ = now;
  sent_stage_ = supervision_.stage();
  const DriveOrder order = Order();
  logger_.order = order;
  if (supervision_.driving()) {
    monitor_.Ordered(now, order);
    // What the car was told in the meantime is where the next command starts from.
    if (!supervision_.stop().empty()) limiter_.Reset(order);
  }
  const bool moves =
      supervision_.driving() && supervision_.stop().empty() && supervision_.emergency().empty();
  const uint16_t time = ToSampleTime(CommandTime(now));
  logger_.steering_on = supervision_.driving();
  frames.push_back(steering_.Pack(
      {.command_time = time, .angle_rad = order.steering_angle, .enable = supervision_.driving()}));
  frames.push_back(front_.Pack({.command_time = time,
                                .left_nm = order.wheel_torque[0],
                                .right_nm = order.wheel_torque[1],
                                .enable = moves}));
  frames.push_back(rear_.Pack({.command_time = time,
                               .left_nm = order.wheel_torque[2],
                               .right_nm = order.wheel_torque[3],
                               .enable = moves}));
  frames.push_back(brake_.Pack({.command_time = time,
                                .level_percent = 100.0 * order.brake,
                                .enable = !supervision_.manual()}));
  if (!supervision_.heartbeat()) return;
  toggle_ = !toggle_;
  frames.push_back(heartbeat_.Pack({.command_time = ToSampleTime(now), .toggle = toggle_}));
}

void CanGateway::AppendStatus(int64_t now, std::vector<CanFrame>& frames) {
  const AsReport& as = supervision_.as();
  dbc::AsStatus status;
  status.command_time = ToSampleTime(now);
  status.state_time = ToSampleTime(as.utime);
  status.as_state = supervision_.emergency().empty()
                        ? static_cast<uint8_t>(std::clamp(as.state, 0, 6))
                        : static_cast<uint8_t>(as_state_t::STATE_EMERGENCY);
  status.mission_finished = as.mission_finished;
  status.deadman_stage = static_cast<uint8_t>(supervision_.stage());
  frames.push_back(as_status_.Pack(status));
}

void CanGateway::AppendLogger(int64_t now, std::vector<CanFrame>& frames) {
  const int64_t cell = now / std::llround(kLoggerPeriod * 1e6);
  if (cell == logger_cell_) return;
  logger_cell_ = cell;
  for (const CanFrame& frame : DataLoggerFrames(logger_)) frames.push_back(frame);
}

std::vector<CanFrame> CanGateway::Farewell(int64_t wall) {
  const int64_t now = Now(wall);
  if (now == 0) return {};
  const uint16_t time = ToSampleTime(now);
  return {
      steering_.Pack({.command_time = time, .angle_rad = logger_.order.steering_angle}),
      front_.Pack({.command_time = time}), rear_.Pack({.command_time = time}),
      brake_.Pack(
          {.command_time = time, .level_percent = 100.0 * params_.parking_brake, .enable = true})};
}

}  // namespace hairpin
