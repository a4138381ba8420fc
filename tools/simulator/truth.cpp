#include "tools/simulator/truth.hpp"

#include <algorithm>
#include <vector>

#include "tools/simulator/track_geometry.hpp"

namespace hairpin {
namespace {

std::vector<truth_cone_t> ToMessage(const std::vector<TrackCone>& cones) {
  std::vector<truth_cone_t> messages;
  for (const TrackCone& cone : cones) {
    truth_cone_t message{};
    message.x_m = cone.position.x();
    message.y_m = cone.position.y();
    message.colour = static_cast<int32_t>(cone.colour);
    messages.push_back(message);
  }
  return messages;
}

}  // namespace

truth_t TruthMessage(const VehicleState& state, int64_t utime) {
  truth_t message{};
  message.utime = utime;
  message.x_m = state.T_map_base.x;
  message.y_m = state.T_map_base.y;
  message.yaw_rad = state.T_map_base.yaw;
  message.vx_mps = state.velocity.vx;
  message.vy_mps = state.velocity.vy;
  message.yaw_rate_radps = state.velocity.yaw_rate;
  message.acceleration_mps2[0] = state.acceleration.x();
  message.acceleration_mps2[1] = state.acceleration.y();
  message.steering_angle_rad = state.steering_angle;
  message.distance_m = state.distance;
  return message;
}

truth_track_t TruthTrackMessage(const Track& track, int64_t utime, uint64_t seed) {
  truth_track_t message{};
  message.utime = utime;
  message.name = track.name;
  message.seed = static_cast<int64_t>(seed);
  message.closed = track.closed ? 1 : 0;
  message.start_x_m = track.start.x;
  message.start_y_m = track.start.y;
  message.start_yaw_rad = track.start.yaw;
  const GateLine& finish = track.finish_line;
  const double line[4] = {finish.left.x(), finish.left.y(), finish.right.x(), finish.right.y()};
  std::copy(std::begin(line), std::end(line), std::begin(message.finish_line_m));
  message.left = ToMessage(track.left);
  message.right = ToMessage(track.right);
  std::vector<TrackCone> all = AllCones(track);
  for (const Eigen::Vector2d& thing : track.clutter) all.push_back({thing, ConeColour::kUnknown});
  message.cones = ToMessage(all);
  message.num_left = static_cast<int32_t>(message.left.size());
  message.num_right = static_cast<int32_t>(message.right.size());
  message.num_cones = static_cast<int32_t>(message.cones.size());
  return message;
}

}  // namespace hairpin
