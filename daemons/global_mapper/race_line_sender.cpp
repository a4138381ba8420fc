#include "daemons/global_mapper/race_line_sender.hpp"

namespace hairpin {
namespace {

// The tracker reads the line at the pose of its own time, and behind it while the car stands [m].
constexpr double kBehind = 3.0;

}  // namespace

RaceLineParams LoadRaceLineParams(const Config& config) {
  RaceLineParams params;
  params.car = LoadCar(config);
  params.corridor.spacing = config.Number("spacing_m", {0.1, 2.0});
  params.corridor.smoothing_length = config.Number("smoothing_length_m", {0.0, 5.0});
  params.corridor.max_half_width = config.Number("max_half_width_m", {1.0, 20.0});
  params.corridor.clearance = config.Number("clearance_m", {0.0, 3.0});
  params.line.max_iterations = config.Integer("max_iterations", 1, 1000);
  params.line.max_step = config.Number("max_step_m", {0.01, 5.0});
  params.line.tolerance = config.Number("tolerance_m", {1e-4, 1.0});
  params.speed.max_speed = config.Number("max_speed_mps", {1.0, 40.0});
  params.speed.lateral_acceleration = config.Number("lateral_acceleration_mps2", {0.5, 20.0});
  params.speed.braking = config.Number("braking_mps2", {0.5, 20.0});
  params.speed.acceleration = config.Number("acceleration_mps2", {0.5, 20.0});
  params.speed.mass = params.car.mass;
  params.speed.downforce = params.car.downforce;
  params.speed.drag = params.car.drag;
  params.speed.rolling_resistance = params.car.rolling_resistance;
  params.speed.max_power = params.car.max_motor_power;
  return params;
}

std::optional<race_line_t> RaceLineMessage(const RaceLine& line, int64_t utime,
                                           const Pose2& T_map_base,
                                           const Eigen::Matrix3d& covariance, double ahead) {
  race_line_t message{};
  message.utime = utime;
  message.x_m = T_map_base.x;
  message.y_m = T_map_base.y;
  message.yaw_rad = T_map_base.yaw;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(message.pose_covariance) = covariance;
  for (const RaceLine::Point& point : Excerpt(line, T_map_base, kBehind, ahead)) {
    message.points.push_back(
        {point.position.x(), point.position.y(), point.speed, point.left, point.right});
  }
  if (message.points.empty()) return std::nullopt;
  message.num_points = static_cast<int32_t>(message.points.size());
  return message;
}

}  // namespace hairpin
