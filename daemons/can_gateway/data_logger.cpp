#include "daemons/can_gateway/data_logger.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "hairpin/as_state_t.hpp"
#include "hairpin/vehicle_t.hpp"

namespace hairpin {
namespace {

constexpr double kKmhPerMps = 3.6;
constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr uint8_t kBrakeDisengaged = 1;
constexpr uint8_t kBrakeEngaged = 2;
constexpr uint8_t kBrakeAvailable = 3;

template <class Integer>
Integer Rounded(double value, double min, double max) {
  return static_cast<Integer>(std::lround(std::clamp(value, min, max)));
}

int8_t MomentPercent(const std::array<double, 4>& torque, double max) {
  const double sum = std::accumulate(torque.begin(), torque.end(), 0.0);
  return Rounded<int8_t>(100.0 * sum / (4.0 * max), -100.0, 100.0);
}

CanFrame Dynamics(const LoggerInput& input) {
  dbc::DvDrivingDynamics1 m;
  m.speed_actual_kmph = Rounded<uint8_t>(kKmhPerMps * input.vehicle.speed, 0.0, 255.0);
  m.speed_target_kmph = Rounded<uint8_t>(kKmhPerMps * input.target_speed, 0.0, 255.0);
  m.steering_actual_deg = kDegPerRad * input.steering.angle;
  m.steering_target_deg = kDegPerRad * input.order.steering_angle;
  m.brake_actual_percent = Rounded<uint8_t>(100.0 * input.brake.level, 0.0, 100.0);
  m.brake_target_percent = Rounded<uint8_t>(100.0 * input.order.brake, 0.0, 100.0);
  m.motor_moment_actual_percent = MomentPercent(input.motors.torque, input.max_wheel_torque);
  m.motor_moment_target_percent = MomentPercent(input.order.wheel_torque, input.max_wheel_torque);
  return dbc::Pack(dbc::Saturated(m));
}

CanFrame Accelerations(const LoggerInput& input) {
  dbc::DvDrivingDynamics2 m;
  m.acceleration_longitudinal_mps2 = input.imu.acceleration[0];
  m.acceleration_lateral_mps2 = input.imu.acceleration[1];
  m.yaw_rate_degps = kDegPerRad * input.imu.angular_rate[2];
  return dbc::Pack(dbc::Saturated(m));
}

// The rules' frame knows no manual driving: the autonomous system is off then, without a mission.
uint8_t AsStatus(int state) {
  if (state == as_state_t::STATE_MANUAL) return as_state_t::STATE_OFF;
  return Rounded<uint8_t>(state, as_state_t::STATE_UNKNOWN, as_state_t::STATE_FINISHED);
}

uint8_t Mission(int mission) {
  const bool known =
      mission >= vehicle_t::MISSION_ACCELERATION && mission <= vehicle_t::MISSION_AUTOCROSS;
  return known ? static_cast<uint8_t>(mission) : uint8_t{vehicle_t::MISSION_UNKNOWN};
}

uint8_t ServiceBrake(const VehicleSample& vehicle) {
  if (vehicle.brakes_engaged) return kBrakeEngaged;
  return vehicle.brakes_ok ? kBrakeAvailable : kBrakeDisengaged;
}

CanFrame Status(const LoggerInput& input) {
  dbc::DvSystemStatus m;
  m.as_status = AsStatus(input.as.state);
  m.ebs_state = Rounded<uint8_t>(input.vehicle.ebs_state, 0.0, 3.0);
  m.mission = Mission(input.vehicle.mission);
  m.steering_state = input.steering_on;
  m.service_brake_state = ServiceBrake(input.vehicle);
  m.lap_counter = Rounded<uint8_t>(input.as.lap, 0.0, 15.0);
  m.cones_count = Rounded<uint8_t>(input.cones, 0.0, 255.0);
  m.cones_count_all = Rounded<uint32_t>(input.cones_all, 0.0, 131071.0);
  return dbc::Pack(m);
}

}  // namespace

std::array<CanFrame, 3> DataLoggerFrames(const LoggerInput& input) {
  return {Dynamics(input), Accelerations(input), Status(input)};
}

}  // namespace hairpin
