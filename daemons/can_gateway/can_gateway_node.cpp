#include "daemons/can_gateway/can_gateway_node.hpp"

#include <algorithm>
#include <iostream>

#include "common/can/cannelloni_port.hpp"
#include "common/can/socketcan_port.hpp"
#include "common/car.hpp"

namespace hairpin {
namespace {

constexpr int kMaxFramesPerPoll = 1'000;
constexpr int64_t kReportPeriod = 1'000'000;  // us

imu_t ToMessage(const ImuSample& sample) {
  imu_t message{};
  message.utime = sample.utime;
  std::copy(sample.acceleration.begin(), sample.acceleration.end(), message.acceleration_mps2);
  std::copy(sample.angular_rate.begin(), sample.angular_rate.end(), message.angular_rate_radps);
  return message;
}

ground_speed_t ToMessage(const GroundSpeedSample& sample) {
  ground_speed_t message{};
  message.utime = sample.utime;
  std::copy(sample.velocity.begin(), sample.velocity.end(), message.velocity_mps);
  message.quality = sample.quality;
  return message;
}

motors_t ToMessage(const MotorsSample& sample) {
  motors_t message{};
  message.utime = sample.utime;
  std::copy(sample.speed.begin(), sample.speed.end(), message.wheel_speed_radps);
  std::copy(sample.torque.begin(), sample.torque.end(), message.wheel_torque_nm);
  return message;
}

vehicle_t ToMessage(const VehicleSample& sample) {
  vehicle_t message{};
  message.utime = sample.utime;
  message.mission = sample.mission;
  message.master_switch_on = sample.master_switch_on;
  message.tractive_system_on = sample.tractive_system_on;
  message.shutdown_circuit_closed = sample.shutdown_circuit_closed;
  message.brakes_engaged = sample.brakes_engaged;
  message.brakes_ok = sample.brakes_ok;
  message.ebs_state = sample.ebs_state;
  message.res_go = sample.res_go;
  message.res_stop = sample.res_stop;
  message.speed_mps = sample.speed;
  return message;
}

Command ToCommand(const drive_command_t& message) {
  Command command;
  command.utime = message.utime;
  command.asks_to_move = message.action != drive_command_t::ACTION_HOLD;
  command.order.steering_angle = message.steering_angle_rad;
  std::copy_n(message.wheel_torque_nm, 4, command.order.wheel_torque.begin());
  command.order.brake = message.brake;
  command.target_speed = message.target_speed_mps;
  return command;
}

SupervisionParams LoadSupervision(const Config& config) {
  SupervisionParams params;
  params.deadman.hold_after = config.Number("hold_after_s", {0.01, 1.0});
  params.deadman.neutral_after = config.Number("neutral_after_s", {params.deadman.hold_after, 1.0});
  params.deadman.silent_after =
      config.Number("silent_after_s", {params.deadman.neutral_after, 1.0});
  params.supervisor_timeout = config.Number("supervisor_timeout_s", {0.05, 1.0});
  params.bus_silence = config.Number("bus_silence_s", {0.02, 1.0});
  params.wheel_speeds_timeout = channels::kMotors.deadline_s;
  return params;
}

ActuatorMonitorParams LoadMonitor(const Config& config) {
  ActuatorMonitorParams params;
  params.disagreement_time = config.Number("disagreement_time_s", {0.02, 1.0});
  params.diverging_factor = config.Number("diverging_factor", {1.1, 10.0});
  params.steering_delay = config.Number("steering_delay_s", {0.0, 0.5});
  params.steering_rate = config.Number("steering_rate_radps", {0.1, 20.0});
  params.steering_tolerance = config.Number("steering_tolerance_rad", {0.005, 0.5});
  params.torque_tolerance = config.Number("torque_tolerance_nm", {1.0, 500.0});
  params.brake_tolerance = config.Number("brake_tolerance", {0.02, 1.0});
  params.settling_time = config.Number("settling_time_s", {0.02, 1.0});
  params.feedback_timeout = config.Number("feedback_timeout_s", {0.02, 1.0});
  return params;
}

}  // namespace

CanGatewayConfig LoadCanGatewayConfig(const Config& config) {
  const Car car = LoadCar(config);
  CanGatewayConfig result;
  CanGatewayParams& params = result.gateway;
  result.interface = config.Text("interface");
  result.local = config.Text("cannelloni_local");
  result.remote = config.Text("cannelloni_remote");
  params.wheel_radius = car.wheel_radius;
  params.limits.max_steering_angle = car.max_steering_angle;
  params.limits.max_wheel_torque = car.max_wheel_torque;
  params.limits.steering_rate = config.Number("max_steering_rate_radps", {0.1, 50.0});
  params.limits.torque_rate = config.Number("max_torque_rate_nmps", {1.0, 1e5});
  params.limits.brake_rate = config.Number("max_brake_release_per_s", {0.1, 100.0});
  params.supervision = LoadSupervision(config.Section("deadman"));
  params.monitor = LoadMonitor(config.Section("actuators"));
  params.stop_brake = config.Number("stop_brake", {0.05, 1.0});
  params.parking_brake = config.Number("parking_brake", {0.05, 1.0});
  config.Finish();
  return result;
}

std::unique_ptr<CanPort> OpenCanPort(const CanGatewayConfig& config, const Clock& clock) {
  if (config.interface != "cannelloni")
    return std::make_unique<SocketCanPort>(config.interface, IdsOfTheCar(), clock);
  return std::make_unique<CannelloniPort>(ParseUdpAddress(config.local),
                                          ParseUdpAddress(config.remote), clock);
}

CanGatewayNode::CanGatewayNode(const CanGatewayParams& params, Bus& bus,
                               std::unique_ptr<CanPort> port, const Clock& clock)
    : bus_(bus), clock_(clock), port_(std::move(port)), gateway_(params) {
  Subscribe();
}

CanGatewayNode::~CanGatewayNode() { port_->Send(gateway_.Farewell(clock_.NowMicros())); }

std::vector<int> CanGatewayNode::descriptors() const {
  return port_->descriptor() < 0 ? std::vector<int>{} : std::vector<int>{port_->descriptor()};
}

void CanGatewayNode::Subscribe() {
  bus_.Subscribe(channels::kDriveCommand, [this](const drive_command_t& message) {
    const std::string problem = gateway_.OnCommand(ToCommand(message), clock_.NowMicros());
    if (!problem.empty()) bus_.Refuse(channels::kDriveCommand, problem);
    SendDue();
  });
  bus_.Subscribe(channels::kAsState, [this](const as_state_t& message) {
    const AsReport report{message.utime, message.state, message.mission, message.lap,
                          message.mission_finished != 0};
    const std::string problem = gateway_.OnAsReport(report, clock_.NowMicros());
    if (!problem.empty()) bus_.Refuse(channels::kAsState, problem);
    SendDue();
  });
  bus_.Subscribe(channels::kPipelineStatus, [this](const pipeline_status_t& message) {
    const SupervisorReport report{message.utime,
                                  message.level >= pipeline_status_t::LEVEL_CONTROLLED_STOP,
                                  message.level >= pipeline_status_t::LEVEL_EMERGENCY};
    const std::string problem = gateway_.OnSupervisor(report, clock_.NowMicros());
    if (!problem.empty()) bus_.Refuse(channels::kPipelineStatus, problem);
  });
  bus_.Subscribe(channels::kLocalMap, [this](const local_map_t& message) {
    gateway_.OnCones(local_cones_ = message.num_cones, global_cones_);
  });
  bus_.Subscribe(channels::kGlobalMap, [this](const global_map_t& message) {
    gateway_.OnCones(local_cones_, global_cones_ = message.num_cones);
  });
}

void CanGatewayNode::Poll() {
  for (int i = 0; i < kMaxFramesPerPoll; ++i) {
    const std::optional<ReceivedFrame> frame = port_->Receive();
    if (!frame) break;
    if (const auto measurement = gateway_.OnFrame(*frame)) Publish(*measurement);
  }
  SendDue();
  Report();
}

void CanGatewayNode::SendDue() {
  gateway_.OnBus(port_->state());
  port_->Send(gateway_.Due(clock_.NowMicros()));
}

void CanGatewayNode::Publish(const Measurement& measurement) {
  if (const auto* imu = std::get_if<ImuSample>(&measurement))
    bus_.Publish(channels::kImu, ToMessage(*imu));
  if (const auto* ground_speed = std::get_if<GroundSpeedSample>(&measurement))
    bus_.Publish(channels::kGroundSpeed, ToMessage(*ground_speed));
  if (const auto* motors = std::get_if<MotorsSample>(&measurement))
    bus_.Publish(channels::kMotors, ToMessage(*motors));
  if (const auto* vehicle = std::get_if<VehicleSample>(&measurement))
    bus_.Publish(channels::kVehicle, ToMessage(*vehicle));
  if (const auto* steering = std::get_if<SteeringSample>(&measurement)) {
    steering_t message{};
    message.utime = steering->utime;
    message.wheel_angle_rad = steering->angle;
    bus_.Publish(channels::kSteering, message);
  }
}

void CanGatewayNode::Report() {
  const std::string& emergency = gateway_.supervision().emergency();
  if (emergency != reported_emergency_) {
    std::cerr << bus_.daemon() << ": the heartbeat has ceased: " << emergency << '\n';
    reported_emergency_ = emergency;
  }
  const int64_t now = clock_.NowMicros();
  const int64_t refused = gateway_.decoder().refused();
  if (now < next_report_ || refused == reported_refusals_) return;
  next_report_ = now + kReportPeriod;
  reported_refusals_ = refused;
  std::cerr << bus_.daemon() << ": CAN: refused " << gateway_.decoder().last_refusal() << " ("
            << refused << " in all)\n";
}

}  // namespace hairpin
