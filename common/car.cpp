#include "common/car.hpp"

#include <numbers>

namespace hairpin {
namespace {

LidarMount LoadMount(const Config& config) {
  LidarMount mount;
  const std::vector<double> position = config.Numbers("position_m", 3, {-3.0, 3.0});
  mount.position = {position[0], position[1], position[2]};
  constexpr Range kAngle{-std::numbers::pi, std::numbers::pi};
  mount.roll = config.Number("roll_rad", kAngle);
  mount.pitch = config.Number("pitch_rad", kAngle);
  mount.yaw = config.Number("yaw_rad", kAngle);
  return mount;
}

}  // namespace

Eigen::Isometry3d LidarMount::Transform() const {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(position);
  T.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  T.rotate(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()));
  T.rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
  return T;
}

std::array<Eigen::Vector2d, 4> Car::wheel_positions() const {
  const double half = 0.5 * track_width;
  return {Eigen::Vector2d(front_axle, half), Eigen::Vector2d(front_axle, -half),
          Eigen::Vector2d(-rear_axle, half), Eigen::Vector2d(-rear_axle, -half)};
}

Car LoadCar(const Config& config) {
  const Config file = config.Sibling("car");
  Car car;
  car.mass = file.Number("mass_kg", {50.0, 1000.0});
  car.yaw_inertia = file.Number("yaw_inertia_kgm2", {10.0, 1000.0});
  car.cog_height = file.Number("cog_height_m", {0.05, 1.0});
  car.front_axle = file.Number("front_axle_m", {0.2, 3.0});
  car.rear_axle = file.Number("rear_axle_m", {0.2, 3.0});
  car.track_width = file.Number("track_width_m", {0.5, 2.5});
  car.wheel_radius = file.Number("wheel_radius_m", {0.1, 0.5});
  car.front_overhang = file.Number("front_overhang_m", {0.2, 4.0});
  car.rear_overhang = file.Number("rear_overhang_m", {0.2, 4.0});
  car.body_width = file.Number("body_width_m", {0.5, 2.5});
  car.max_steering_angle = file.Number("max_steering_angle_rad", {0.1, 1.0});
  car.max_wheel_torque = file.Number("max_wheel_torque_nm", {10.0, 1000.0});
  car.max_brake_force = file.Number("max_brake_force_n", {100.0, 20000.0});
  car.front_brake_share = file.Number("front_brake_share", {0.0, 1.0});
  car.max_motor_power = file.Number("max_motor_power_w", {1e3, 1e6});
  car.drag = file.Number("drag_n_per_mps2", {0.0, 10.0});
  car.downforce = file.Number("downforce_n_per_mps2", {0.0, 10.0});
  car.rolling_resistance = file.Number("rolling_resistance_n", {0.0, 1000.0});
  const std::vector<double> ground_speed = file.Numbers("ground_speed_position_m", 2, {-3.0, 3.0});
  car.ground_speed_position = {ground_speed[0], ground_speed[1]};
  const std::vector<double> gnss = file.Numbers("gnss_position_m", 2, {-3.0, 3.0});
  car.gnss_position = {gnss[0], gnss[1]};
  const Config lidars = file.Section("lidars");
  car.lidar_front = LoadMount(lidars.Section("front"));
  car.lidar_top = LoadMount(lidars.Section("top"));
  return car;
}

}  // namespace hairpin
