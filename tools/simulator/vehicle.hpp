#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/car.hpp"
#include "common/geometry.hpp"
#include "tools/simulator/tyre.hpp"

namespace hairpin {

struct VehicleParams {
  TyreParams tyre;
  double wheel_inertia_kgm2 = 0.0;  // one wheel with its motor and gear
  double drag_ns2pm2 = 0.0;         // force = drag * v^2
  double downforce_ns2pm2 = 0.0;    // force = downforce * v^2
  double downforce_front_share = 0.0;
  double rolling_resistance_n = 0.0;  // of the whole car at its static load
  double front_roll_share = 0.0;      // of the lateral load transfer that the front axle takes
  double load_transfer_time_s = 0.0;  // until the springs have passed it on
  double steering_delay_s = 0.0;
  double steering_rate_radps = 0.0;  // limit, of the front wheels
  double motor_time_constant_s = 0.0;
  double max_motor_power_w = 0.0;      // of all four together, driving or regenerating
  double regeneration_fade_mps = 0.0;  // below this wheel speed regeneration fades out
  double brake_time_constant_s = 0.0;  // of the brake pressure
};

/// What reaches the actuators, within the car's limits.
struct VehicleInput {
  double steering_angle = 0.0;           // of the front wheels, positive to the left [rad]
  std::array<double, 4> wheel_torque{};  // fl fr rl rr [N m]
  double brake = 0.0;                    // 0 to 1 of the full pressure
};

struct VehicleState {
  Pose2 T_map_base;
  Twist2 velocity;  // of base, in base
  Eigen::Vector2d acceleration =
      Eigen::Vector2d::Zero();  // in base, without gravity; mean of the last Advance() [m/s^2]
  double steering_angle = 0.0;  // [rad]
  double brake = 0.0;           // pressure, 0 to 1
  std::array<double, 4> wheel_speed{};   // fl fr rl rr [rad/s]
  std::array<double, 4> wheel_torque{};  // of the motors, at the wheel [N m]
  std::array<double, 4> wheel_load{};    // [N]
  double distance = 0.0;                 // driven [m]
};

/// Planar double-track model: magic formula tyres with combined slip and relaxation, quasi-static
/// load transfer, spinning wheels with motors and friction brakes, aerodynamics, steering with
/// delay and rate limit (both front wheels alike). Fixed internal step, deterministic; from a true
/// standstill, held by brakes or rolling resistance, upwards.
class Vehicle {
 public:
  static constexpr double kStep =
      1e-3;  // s; a fifth of the fastest time constant, wheel against tyre

  /// `start`: T_map_base. `speed` [m/s]: forward, wheels rolling. Throws std::invalid_argument for
  /// values that cannot be.
  Vehicle(const VehicleParams& params, const Car& car, const Pose2& start, double speed = 0.0);

  /// Moves on by `steps` of kStep with constant input.
  void Advance(const VehicleInput& input, int steps);

  const VehicleState& state() const { return state_; }

 private:
  struct Forces {
    Eigen::Vector2d force = Eigen::Vector2d::Zero();  // in base [N]
    double yaw_moment = 0.0;
  };

  void Step(const VehicleInput& input);
  void StepActuators(const VehicleInput& input);
  void StepLoads();
  Forces StepWheels();
  void SpinWheel(size_t wheel, double tyre_force);
  void StepBody(const Forces& forces);

  VehicleParams params_;
  Car car_;
  std::array<Eigen::Vector2d, 4> wheel_positions_;
  std::vector<Tyre> tyres_;
  VehicleState state_;
  std::vector<double> delayed_steering_;  // ring of commands on their way
  size_t next_steering_ = 0;
  std::array<double, 4> motor_torque_{};  // before regeneration fades
  Eigen::Vector2d transferred_ =
      Eigen::Vector2d::Zero();  // acceleration that the loads have followed
  Eigen::Vector2d acceleration_ = Eigen::Vector2d::Zero();
};

}  // namespace hairpin
