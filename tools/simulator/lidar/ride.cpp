#include "tools/simulator/lidar/ride.hpp"

#include <cmath>

namespace hairpin {

Eigen::Isometry3d RidePose(const RideParams& params, const Car& car, const Terrain& terrain,
                           const VehicleState& state) {
  std::array<double, 4> height{};
  const auto wheels = car.wheel_positions();  // fl fr rl rr
  for (size_t i = 0; i < wheels.size(); ++i) {
    const Eigen::Vector2d wheel = state.T_map_base * wheels[i];
    height[i] = terrain.Height(wheel.x(), wheel.y());
  }
  const double front = 0.5 * (height[0] + height[1]);
  const double rear = 0.5 * (height[2] + height[3]);
  const double left = 0.5 * (height[0] + height[2]);
  const double right = 0.5 * (height[1] + height[3]);
  const double ground_pitch = std::atan2(rear - front, car.wheelbase());  // positive: nose down
  const double ground_roll = std::atan2(left - right, car.track_width);
  const double pitch = ground_pitch - params.pitch_per_acceleration * state.acceleration.x();
  const double roll = ground_roll + params.roll_per_acceleration * state.acceleration.y();
  const double z = rear + (front - rear) * car.rear_axle / car.wheelbase();
  LidarMount pose;  // the same convention of angles
  pose.position = {state.T_map_base.x, state.T_map_base.y, z};
  pose.roll = roll;
  pose.pitch = pitch;
  pose.yaw = state.T_map_base.yaw;
  return pose.Transform();
}

}  // namespace hairpin
