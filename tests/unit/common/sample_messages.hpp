#pragma once

#include <cstdint>
#include <vector>

#include "common/channels.hpp"

namespace hairpin {

/// Payload as it stands on the wire, fingerprint included.
template <class M>
std::vector<uint8_t> Encoded(const M& message) {
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

// Messages whose arrays and strings are not empty, so that a test reaches every kind of field.

inline void Fill(cones_t& m) {
  m.sectors.resize(1);
  m.cones.resize(2);
  m.num_sectors = 1;
  m.num_cones = 2;
}
inline void Fill(lidar_scan_t& m) {
  m.sensor_model = "VLP-32C";
  m.ring_elevation_rad = {-0.1F, 0.0F};
  m.num_rings = 2;
  m.points.resize(20);
  m.num_bytes = 20;
  m.num_points = 2;
}
inline void Fill(cone_clusters_t& m) {
  m.sectors.resize(1);
  m.clusters.resize(1);
  m.num_sectors = m.num_clusters = 1;
  cone_cluster_t& cluster = m.clusters[0];
  cluster.x_m = cluster.y_m = cluster.z_m = cluster.age_s = {1.0F, 2.0F};
  cluster.intensity = {10, 200};
  cluster.num_points = 2;
}
inline void Fill(global_map_t& m) {
  m.cones.resize(2);
  m.num_cones = 2;
}
inline void Fill(race_line_t& m) {
  m.points.resize(2);
  m.num_points = 2;
}
inline void Fill(heartbeat_t& m) {
  m.daemon = "path_tracker";
  m.build = "0123456789ab";
  m.channels.resize(2);
  m.channels[0].channel = "TRACK";
  m.num_channels = 2;
}
inline void Fill(pipeline_status_t& m) {
  m.reason = "CONES_FUSION is stale";
  m.culprits = {"CONES_FUSION", "GNSS"};
  m.num_culprits = 2;
}
inline void Fill(local_map_t& m) {
  m.cones.resize(2);
  m.num_cones = 2;
}
inline void Fill(track_t& m) {
  m.path.resize(2);
  m.left.resize(1);
  m.right.resize(1);
  m.num_points = 2;
  m.num_left = m.num_right = 1;
}
inline void Fill(truth_track_t& m) {
  m.name = "default";
  m.cones.resize(1);
  m.left.resize(1);
  m.right.resize(1);
  m.num_cones = m.num_left = m.num_right = 1;
}
inline void Fill(as_state_t& m) { m.reason = "ready"; }
template <class M>
void Fill(M&) {}

template <class M>
M Sample(int64_t utime, int64_t boot_id = 1, int32_t sequence = 0) {
  M message{};
  message.utime = utime;
  message.boot_id = boot_id;
  message.sequence = sequence;
  Fill(message);
  return message;
}

// Calls `visit(real)` for every float and double of a message.

template <class T, size_t N, class Visitor>
void VisitAll(T (&array)[N], Visitor& visit) {
  for (T& real : array) visit(real);
}
template <class Visitor, class... Reals>
void VisitEach(Visitor& visit, Reals&... reals) {
  (visit(reals), ...);
}
template <class Visitor>
void VisitReals(imu_t& m, Visitor visit) {
  VisitAll(m.acceleration_mps2, visit);
  VisitAll(m.angular_rate_radps, visit);
}
template <class Visitor>
void VisitReals(ground_speed_t& m, Visitor visit) {
  VisitAll(m.velocity_mps, visit);
  visit(m.quality);
}
template <class Visitor>
void VisitReals(motors_t& m, Visitor visit) {
  VisitAll(m.wheel_speed_radps, visit);
  VisitAll(m.wheel_torque_nm, visit);
}
template <class Visitor>
void VisitReals(steering_t& m, Visitor visit) {
  visit(m.wheel_angle_rad);
}
template <class Visitor>
void VisitReals(gnss_t& m, Visitor visit) {
  VisitAll(m.position_enu_m, visit);
  VisitAll(m.position_sigma_m, visit);
  VisitAll(m.velocity_enu_mps, visit);
  VisitAll(m.velocity_sigma_mps, visit);
  VisitEach(visit, m.heading_rad, m.heading_sigma_rad);
}
template <class Visitor>
void VisitReals(vehicle_t& m, Visitor visit) {
  visit(m.speed_mps);
}
template <class Visitor>
void VisitReals(velocity_t& m, Visitor visit) {
  VisitEach(visit, m.vx_mps, m.vy_mps, m.yaw_rate_radps);
  VisitAll(m.covariance, visit);
  VisitAll(m.acceleration_mps2, visit);
  VisitAll(m.wheel_slip, visit);
}
template <class Visitor>
void VisitReals(lidar_scan_t& m, Visitor visit) {
  VisitEach(visit, m.covered_share, m.azimuth_step_rad, m.coordinate_step_m, m.time_step_s);
  for (auto& elevation : m.ring_elevation_rad) visit(elevation);
}
// A cone with position, covariance and colour, whatever else it has.
template <class Cone, class Visitor>
void VisitCone(Cone& c, Visitor& visit) {
  VisitEach(visit, c.x_m, c.y_m, c.covariance_xx_m2, c.covariance_xy_m2, c.covariance_yy_m2);
  VisitAll(c.probability, visit);
}
template <class Visitor>
void VisitReals(cones_t& m, Visitor visit) {
  for (auto& s : m.sectors) VisitEach(visit, s.min_bearing_rad, s.max_bearing_rad, s.max_range_m);
  for (auto& c : m.cones) VisitCone(c, visit);
}
template <class Visitor>
void VisitReals(cone_clusters_t& m, Visitor visit) {
  for (auto& s : m.sectors) VisitEach(visit, s.min_bearing_rad, s.max_bearing_rad, s.max_range_m);
  for (auto& cluster : m.clusters) {
    VisitCone(cluster.cone, visit);
    for (auto* reals : {&cluster.x_m, &cluster.y_m, &cluster.z_m, &cluster.age_s}) {
      for (auto& real : *reals) visit(real);
    }
  }
}
template <class Visitor>
void VisitReals(global_map_t& m, Visitor visit) {
  VisitEach(visit, m.x_m, m.y_m, m.yaw_rad);
  VisitAll(m.pose_covariance, visit);
  VisitAll(m.T_map_local, visit);
  for (auto& c : m.cones) VisitCone(c, visit);
}
template <class Visitor>
void VisitReals(race_line_t& m, Visitor visit) {
  VisitEach(visit, m.x_m, m.y_m, m.yaw_rad);
  VisitAll(m.pose_covariance, visit);
  for (auto& p : m.points) VisitEach(visit, p.x_m, p.y_m, p.speed_mps, p.left_m, p.right_m);
}
template <class Visitor>
void VisitReals(pipeline_status_t& m, Visitor visit) {
  visit(m.speed_cap_mps);
}
template <class Visitor>
void VisitReals(local_map_t& m, Visitor visit) {
  VisitEach(visit, m.x_m, m.y_m, m.yaw_rad);
  for (auto& c : m.cones) {
    VisitCone(c, visit);
    visit(c.existence);
  }
}
template <class Visitor>
void VisitReals(path_score_t& m, Visitor visit) {
  VisitAll(m.term, visit);
  VisitEach(visit, m.log_prior, m.log_likelihood, m.log_posterior);
}
template <class Visitor>
void VisitReals(track_t& m, Visitor visit) {
  VisitEach(visit, m.x_m, m.y_m, m.yaw_rad, m.length_m, m.seen_length_m);
  for (auto& p : m.path) VisitEach(visit, p.x_m, p.y_m, p.width_m);
  for (auto& p : m.left) VisitEach(visit, p.x_m, p.y_m);
  for (auto& p : m.right) VisitEach(visit, p.x_m, p.y_m);
  VisitReals(m.winner, visit);
  VisitReals(m.runner_up, visit);
}
template <class Visitor>
void VisitReals(as_state_t& m, Visitor visit) {
  visit(m.distance_m);
}
template <class Visitor>
void VisitReals(drive_command_t& m, Visitor visit) {
  VisitAll(m.wheel_torque_nm, visit);
  VisitEach(visit, m.steering_angle_rad, m.brake, m.target_speed_mps, m.target_acceleration_mps2,
            m.lateral_error_m);
}
template <class Visitor>
void VisitReals(heartbeat_t&, Visitor) {}
template <class Visitor>
void VisitReals(truth_t& m, Visitor visit) {
  VisitEach(visit, m.x_m, m.y_m, m.yaw_rad, m.vx_mps, m.vy_mps, m.yaw_rate_radps,
            m.steering_angle_rad, m.distance_m);
  VisitAll(m.acceleration_mps2, visit);
}
template <class Visitor>
void VisitReals(truth_track_t& m, Visitor visit) {
  VisitEach(visit, m.start_x_m, m.start_y_m, m.start_yaw_rad);
  VisitAll(m.finish_line_m, visit);
  for (auto* cones : {&m.cones, &m.left, &m.right}) {
    for (auto& c : *cones) VisitEach(visit, c.x_m, c.y_m);
  }
}

}  // namespace hairpin
