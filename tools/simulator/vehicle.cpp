#include "tools/simulator/vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulator/require.hpp"

namespace hairpin {
namespace {

constexpr double kGravity = 9.81;

void Check(const VehicleParams& params) {
  RequirePositive("wheel_inertia", params.wheel_inertia_kgm2);
  RequireNotNegative("drag", params.drag_ns2pm2);
  RequireNotNegative("downforce", params.downforce_ns2pm2);
  RequireWithin("downforce_front_share", params.downforce_front_share, 0.0, 1.0);
  RequireNotNegative("rolling_resistance", params.rolling_resistance_n);
  RequireWithin("front_roll_share", params.front_roll_share, 0.0, 1.0);
  RequireWithin("load_transfer_time", params.load_transfer_time_s, Vehicle::kStep, 1.0);
  RequireWithin("steering_delay", params.steering_delay_s, 0.0, 1.0);
  RequirePositive("steering_rate", params.steering_rate_radps);
  RequireWithin("motor_time_constant", params.motor_time_constant_s, Vehicle::kStep, 1.0);
  RequirePositive("max_motor_power", params.max_motor_power_w);
  RequirePositive("regeneration_fade", params.regeneration_fade_mps);
  RequireWithin("brake_time_constant", params.brake_time_constant_s, Vehicle::kStep, 1.0);
}

// First-order lag towards `target`.
double Lagged(double value, double target, double time_constant) {
  return value + (target - value) * Vehicle::kStep / time_constant;
}

bool IsFront(size_t wheel) { return wheel < 2; }
bool IsLeft(size_t wheel) { return wheel % 2 == 0; }

}  // namespace

Vehicle::Vehicle(const VehicleParams& params, const Car& car, const Pose2& start, double speed)
    : params_(params), car_(car), wheel_positions_(car.wheel_positions()) {
  Check(params);
  tyres_.assign(4, Tyre(params.tyre, car.mass * kGravity / 4.0));
  state_.T_map_base = start;
  state_.velocity.vx = speed;
  state_.wheel_speed.fill(speed / car.wheel_radius);
  delayed_steering_.assign(static_cast<size_t>(std::lround(params.steering_delay_s / kStep)) + 1,
                           0.0);
}

void Vehicle::Advance(const VehicleInput& input, int steps) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < steps; ++i) {
    Step(input);
    sum += acceleration_;
  }
  if (steps > 0) state_.acceleration = sum / steps;
}

void Vehicle::Step(const VehicleInput& input) {
  StepActuators(input);
  StepLoads();
  StepBody(StepWheels());
}

void Vehicle::StepActuators(const VehicleInput& input) {
  delayed_steering_[next_steering_] =
      std::clamp(input.steering_angle, -car_.max_steering_angle, car_.max_steering_angle);
  next_steering_ = (next_steering_ + 1) % delayed_steering_.size();
  const double most = params_.steering_rate_radps * kStep;
  state_.steering_angle +=
      std::clamp(delayed_steering_[next_steering_] - state_.steering_angle, -most, most);
  state_.brake =
      Lagged(state_.brake, std::clamp(input.brake, 0.0, 1.0), params_.brake_time_constant_s);

  double power = 0.0;
  for (size_t i = 0; i < 4; ++i) {
    const double wanted =
        std::clamp(input.wheel_torque[i], -car_.max_wheel_torque, car_.max_wheel_torque);
    motor_torque_[i] = Lagged(motor_torque_[i], wanted, params_.motor_time_constant_s);
    // The rules forbid to drive backwards: a motor slows its wheel, and lets go of it before it
    // turns the other way.
    const double fade = std::clamp(
        state_.wheel_speed[i] * car_.wheel_radius / params_.regeneration_fade_mps, 0.0, 1.0);
    state_.wheel_torque[i] = motor_torque_[i] < 0.0 ? motor_torque_[i] * fade : motor_torque_[i];
    power += state_.wheel_torque[i] * state_.wheel_speed[i];
  }
  if (std::abs(power) <= params_.max_motor_power_w) return;
  for (double& torque : state_.wheel_torque) torque *= params_.max_motor_power_w / std::abs(power);
}

void Vehicle::StepLoads() {
  transferred_ += (acceleration_ - transferred_) * (kStep / params_.load_transfer_time_s);
  const double weight = car_.mass * kGravity;
  const double downforce = params_.downforce_ns2pm2 * state_.velocity.vx * state_.velocity.vx;
  const double to_rear = car_.mass * transferred_.x() * car_.cog_height / car_.wheelbase();
  const double to_right = car_.mass * transferred_.y() * car_.cog_height / car_.track_width;
  const double front = weight * car_.rear_axle / car_.wheelbase() +
                       downforce * params_.downforce_front_share - to_rear;
  const double rear = weight + downforce - front;
  for (size_t i = 0; i < 4; ++i) {
    const double axle = IsFront(i) ? front : rear;
    const double moved =
        to_right * (IsFront(i) ? params_.front_roll_share : 1.0 - params_.front_roll_share);
    state_.wheel_load[i] = std::max(0.5 * axle + (IsLeft(i) ? -moved : moved), 0.0);
  }
}

Vehicle::Forces Vehicle::StepWheels() {
  const Twist2& v = state_.velocity;
  const double cos_steer = std::cos(state_.steering_angle);
  const double sin_steer = std::sin(state_.steering_angle);
  Forces sum;
  for (size_t i = 0; i < 4; ++i) {
    const double c = IsFront(i) ? cos_steer : 1.0;
    const double s = IsFront(i) ? sin_steer : 0.0;
    const Eigen::Vector2d& p = wheel_positions_[i];
    const Eigen::Vector2d hub(v.vx - v.yaw_rate * p.y(), v.vy + v.yaw_rate * p.x());  // v + r x p
    const Eigen::Vector2d hub_wheel(c * hub.x() + s * hub.y(), -s * hub.x() + c * hub.y());
    const Eigen::Vector2d sliding(state_.wheel_speed[i] * car_.wheel_radius - hub_wheel.x(),
                                  -hub_wheel.y());
    tyres_[i].Step(sliding, std::abs(hub_wheel.x()), kStep);
    const Eigen::Vector2d force_wheel = tyres_[i].Force(state_.wheel_load[i]);
    const Eigen::Vector2d force(c * force_wheel.x() - s * force_wheel.y(),
                                s * force_wheel.x() + c * force_wheel.y());
    SpinWheel(i, force_wheel.x());
    sum.force += force;
    sum.yaw_moment += p.x() * force.y() - p.y() * force.x();
  }
  sum.force -= params_.drag_ns2pm2 * std::hypot(v.vx, v.vy) * Eigen::Vector2d(v.vx, v.vy);
  return sum;
}

void Vehicle::SpinWheel(size_t wheel, double tyre_force) {
  // J omega' = T - F R - (T_brake + T_rolling) sign(omega): dry friction, which holds a wheel that
  // it can stop.
  const double share = IsFront(wheel) ? car_.front_brake_share : 1.0 - car_.front_brake_share;
  const double brake = 0.5 * share * state_.brake * car_.max_brake_force * car_.wheel_radius;
  const double rolling = params_.rolling_resistance_n * car_.wheel_radius *
                         state_.wheel_load[wheel] / (car_.mass * kGravity);
  const double per_torque = kStep / params_.wheel_inertia_kgm2;
  double& speed = state_.wheel_speed[wheel];
  const double free =
      speed + per_torque * (state_.wheel_torque[wheel] - tyre_force * car_.wheel_radius);
  const double held = per_torque * (brake + rolling);
  speed = std::abs(free) <= held ? 0.0 : free - std::copysign(held, free);
}

void Vehicle::StepBody(const Forces& forces) {
  acceleration_ = forces.force / car_.mass;
  Twist2& v = state_.velocity;
  const double vx = v.vx;
  v.vx += kStep * (acceleration_.x() + v.yaw_rate * v.vy);
  v.vy += kStep * (acceleration_.y() - v.yaw_rate * vx);
  v.yaw_rate += kStep * forces.yaw_moment / car_.yaw_inertia;
  state_.T_map_base = state_.T_map_base * Integrate(v, kStep);
  state_.distance += kStep * std::hypot(v.vx, v.vy);
}

}  // namespace hairpin
