#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "tools/report/log_writer.hpp"
#include "tools/report/run_log.hpp"

namespace hairpin {

/// A run that never was: a car drives round an oval, counter-clockwise, and its map and paths are
/// wrong exactly as asked.
struct SyntheticRunParams {
  double straight = 40.0;  // m
  double radius = 15.0;
  double half_width = 1.75;
  double cone_spacing = 3.0;
  double distance = 130.0;  // driven, about three quarters of the lap
  double speed = 10.0;
  double speed_swing = 0.0;  // slower in the bends by this much
  unsigned seed = 1;
  Pose2 T_map_local{5.0, -3.0, 0.7};  // at the start
  double yaw_drift_radps = 0.0;
  double position_noise = 0.0;  // sigma per axis of every published cone [m]
  double wrong_colour_beyond = 1e9;
  double path_length = 16.0;                  // of the seen part
  std::optional<double> path_leaves_at;       // crosses the left boundary after so many m
  std::optional<Eigen::Vector2d> false_cone;  // map, held for certain during the following
  double false_from_s = 5.0;                  // since the Go
  double false_until_s = 5.4;
  double vx_error = 0.0;
  std::optional<double> fusion_off_s;  // since the Go, for 5 s
};

class SyntheticRun {
 public:
  static constexpr int64_t kStartUtime = 1'600'000'000'000'000;
  static constexpr double kGoS = 1.0;

  explicit SyntheticRun(const SyntheticRunParams& params) : p_(params), random_(params.seed) {
    MakeTrack();
  }

  double perimeter() const { return 2.0 * p_.straight + 2.0 * std::numbers::pi * p_.radius; }

  /// Pose on the middle line, `distance` from the start of the lower straight.
  Pose2 Middle(double distance) const {
    const double bend = std::numbers::pi * p_.radius;
    double s = std::fmod(std::fmod(distance, perimeter()) + perimeter(), perimeter());
    const bool upper = s >= p_.straight + bend;
    if (upper) s -= p_.straight + bend;
    const double angle = s <= p_.straight ? 0.0 : (s - p_.straight) / p_.radius;
    const Pose2 half{std::min(s, p_.straight) + p_.radius * std::sin(angle),
                     p_.radius * (1.0 - std::cos(angle)), angle};
    const Pose2 opposite{p_.straight, 2.0 * p_.radius, std::numbers::pi};
    return upper ? opposite * half : half;
  }

  RunLog Make() {
    log_.truth_track = track_;
    for (int tick = 0; truth_s_ < kStart + p_.distance; ++tick) Tick(tick);
    return log_;
  }

 private:
  static constexpr double kStart = 20.0;  // m along the lower straight
  static constexpr double kPeriod = 0.01;

  Eigen::Vector2d Beside(double distance, double left) const {
    return Middle(distance) * Eigen::Vector2d(0.0, left);
  }

  void MakeTrack() {
    track_.utime = kStartUtime;
    track_.name = "oval";
    track_.seed = p_.seed;
    track_.closed = true;
    const Pose2 start = Middle(kStart);
    track_.start_x_m = start.x;
    track_.start_y_m = start.y;
    const double line = kStart + 6.0;
    const Eigen::Vector2d gate[] = {Beside(line, p_.half_width), Beside(line, -p_.half_width)};
    for (int i = 0; i < 4; ++i) track_.finish_line_m[i] = gate[i / 2](i % 2);
    const int count = static_cast<int>(perimeter() / p_.cone_spacing);
    for (int i = 0; i < count; ++i) {
      const double s = line + i * perimeter() / count;
      const Eigen::Vector2d left = Beside(s, p_.half_width);
      const Eigen::Vector2d right = Beside(s, -p_.half_width);
      track_.left.push_back({left.x(), left.y(), cone_observation_t::BLUE});
      track_.right.push_back({right.x(), right.y(), cone_observation_t::YELLOW});
    }
    track_.cones = track_.left;
    track_.cones.insert(track_.cones.end(), track_.right.begin(), track_.right.end());
    track_.num_left = track_.num_right = count;
    track_.num_cones = 2 * count;
  }

  double since_go() const { return static_cast<double>(utime_ - kStartUtime) * 1e-6 - kGoS; }

  void Tick(int tick) {
    utime_ = kStartUtime + tick * 10'000;
    Drive();
    AddTruth();
    AddVelocity();
    if (tick % 5 == 0) AddAsState();
    if (tick % 2 == 0) AddStatus();
    if (tick % 10 == 0) {
      AddCones();
      AddLocalMap();
      AddPath();
    }
    AddCommand();
  }

  void Drive() {
    const Pose2 before = Middle(truth_s_);
    const double phase = 4.0 * std::numbers::pi * (truth_s_ - p_.straight / 2.0) / perimeter();
    speed_ = since_go() < 0.0 ? 0.0 : p_.speed - p_.speed_swing * (1.0 - std::cos(phase)) / 2.0;
    truth_s_ += speed_ * kPeriod;
    truth_pose_ = Middle(truth_s_);
    const Pose2 step = before.Inverse() * truth_pose_;
    if (log_.truth.empty()) local_pose_ = p_.T_map_local.Inverse() * before;
    yaw_rate_ = step.yaw / kPeriod;
    local_pose_ = local_pose_ * step *
                  Pose2{0.0, 0.0, p_.yaw_drift_radps * kPeriod * (speed_ > 0.0 ? 1.0 : 0.0)};
  }

  void AddTruth() {
    truth_t truth{};
    truth.utime = utime_;
    truth.x_m = truth_pose_.x;
    truth.y_m = truth_pose_.y;
    truth.yaw_rad = truth_pose_.yaw;
    truth.vx_mps = speed_;
    truth.yaw_rate_radps = yaw_rate_;
    truth.distance_m = truth_s_ - kStart;
    log_.truth.push_back(truth);
  }

  void AddVelocity() {
    velocity_t velocity{};
    velocity.utime = utime_;
    velocity.valid = true;
    velocity.vx_mps = speed_ + p_.vx_error;
    velocity.yaw_rate_radps = yaw_rate_;
    log_.velocities.push_back(velocity);
  }

  void AddAsState() {
    as_state_t state{};
    state.utime = utime_;
    state.state = as_state_t::STATE_DRIVING;
    if (since_go() < 0.0) state.state = as_state_t::STATE_READY;
    log_.as_states.push_back(state);
  }

  bool FusionIsOff(double late) const {
    return p_.fusion_off_s && since_go() >= *p_.fusion_off_s + late &&
           since_go() < *p_.fusion_off_s + 5.0;
  }

  void AddStatus() {
    pipeline_status_t status{};
    status.utime = utime_;
    status.lidar_fresh = status.camera_fresh = true;
    status.fusion_fresh = !FusionIsOff(0.15);
    status.map_mode = pipeline_status_t::MODE_FUSION;
    status.reason = "all pipelines fresh";
    if (!status.fusion_fresh) {
      status.map_mode = pipeline_status_t::MODE_LIDAR_AND_CAMERA;
      status.reason = "CONES_FUSION is stale";
    }
    status.speed_cap_mps = 12.0;
    log_.pipeline_status.push_back(status);
  }

  void AddCones() {
    cones_t cones{};
    cones.utime = utime_;
    if (!FusionIsOff(0.0)) log_.cones_fusion.push_back(cones);
  }

  local_cone_t ToLocal(int64_t id, const Eigen::Vector2d& position_map, int32_t colour) {
    std::normal_distribution<double> noise(0.0, 1.0);
    const Eigen::Vector2d base = truth_pose_.Inverse() * position_map;
    const Eigen::Vector2d position = local_pose_ * base;
    local_cone_t cone{};
    cone.id = id;
    cone.last_seen_utime = utime_;
    cone.x_m = position.x() + p_.position_noise * noise(random_);
    cone.y_m = position.y() + p_.position_noise * noise(random_);
    cone.covariance_xx_m2 = cone.covariance_yy_m2 = 0.01;
    const bool wrong = base.norm() > p_.wrong_colour_beyond;
    cone.probability[wrong ? 3 - colour : colour] = 0.97F;
    cone.probability[0] = 0.03F;
    cone.existence = 0.95F;
    cone.num_observations = ++observations_[id];
    return cone;
  }

  void AddLocalMap() {
    constexpr double kRange = 18.0;
    local_map_t map{};
    map.utime = utime_;
    map.epoch = 7;
    map.x_m = local_pose_.x;
    map.y_m = local_pose_.y;
    map.yaw_rad = local_pose_.yaw;
    for (int i = 0; i < track_.num_cones; ++i) {
      const truth_cone_t& cone = track_.cones[static_cast<size_t>(i)];
      const Eigen::Vector2d position(cone.x_m, cone.y_m);
      const bool near = (position - truth_pose_.position()).norm() < kRange;
      if (near && !was_near_[i]) ++visits_[i];
      was_near_[i] = near;
      if (near) map.cones.push_back(ToLocal(i + 1 + 10'000 * visits_[i], position, cone.colour));
    }
    const bool is_false =
        p_.false_cone && since_go() >= p_.false_from_s && since_go() < p_.false_until_s;
    if (is_false) map.cones.push_back(ToLocal(9'999, *p_.false_cone, cone_observation_t::BLUE));
    map.num_cones = static_cast<int32_t>(map.cones.size());
    log_.local_maps.push_back(map);
  }

  void AddPath() {
    track_t path{};
    path.utime = utime_;
    path.valid = true;
    path.x_m = local_pose_.x;
    path.y_m = local_pose_.y;
    path.yaw_rad = local_pose_.yaw;
    path.seen_length_m = p_.path_length;
    path.length_m = p_.path_length + 3.0;
    for (int i = 0; 0.5 * i <= path.length_m; ++i) {
      const double ahead = 0.5 * i;
      const double beside =
          p_.path_leaves_at && ahead > *p_.path_leaves_at - p_.half_width ? 3.0 : 0.0;
      const Eigen::Vector2d point = ToLocal(Beside(truth_s_ + ahead, beside));
      path.path.push_back({point.x(), point.y(), 3.5, ahead > p_.path_length});
    }
    for (double ahead = 0.0; ahead <= p_.path_length; ahead += p_.cone_spacing) {
      const Eigen::Vector2d left = ToLocal(Beside(truth_s_ + ahead, p_.half_width));
      const Eigen::Vector2d right = ToLocal(Beside(truth_s_ + ahead, -p_.half_width));
      path.left.push_back({1, left.x(), left.y()});
      path.right.push_back({1, right.x(), right.y()});
    }
    path.num_points = static_cast<int32_t>(path.path.size());
    path.num_left = path.num_right = static_cast<int32_t>(path.left.size());
    log_.tracks.push_back(path);
  }

  Eigen::Vector2d ToLocal(const Eigen::Vector2d& point_map) const {
    return local_pose_ * (truth_pose_.Inverse() * point_map);
  }

  void AddCommand() {
    drive_command_t command{};
    command.utime = utime_;
    command.track_utime = log_.tracks.back().utime;
    command.action = drive_command_t::ACTION_DRIVE;
    if (since_go() < 0.0) command.action = drive_command_t::ACTION_HOLD;
    command.target_speed_mps = p_.speed;
    command.lateral_error_m = 0.1 * std::sin(truth_s_ / 5.0);
    log_.drive_commands.push_back(command);
  }

  SyntheticRunParams p_;
  std::mt19937 random_;
  truth_track_t track_{};
  RunLog log_;
  int64_t utime_ = kStartUtime;
  double truth_s_ = kStart;
  double speed_ = 0.0;
  double yaw_rate_ = 0.0;
  Pose2 truth_pose_;
  Pose2 local_pose_;
  std::map<int64_t, int32_t> observations_;
  std::map<int, bool> was_near_;
  std::map<int, int> visits_;
};

inline RunLog MakeSyntheticRun(const SyntheticRunParams& params) {
  return SyntheticRun(params).Make();
}

template <class M>
std::vector<uint8_t> Encoded(const M& message) {
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

/// Records the run as the drive program would, one channel after another.
inline void WriteRunLog(const RunLog& log, const std::string& path) {
  LogWriter writer(path);
  const auto write_all = [&writer](const auto& channel, const auto& messages) {
    int32_t sequence = 0;
    for (auto message : messages) {
      message.sequence = sequence++;
      const auto bytes = Encoded(message);
      writer.Write(message.utime, channel.name, bytes.data(), bytes.size());
    }
  };
  write_all(channels::kTruthTrack, std::vector{*log.truth_track});
  write_all(channels::kTruth, log.truth);
  write_all(channels::kLocalMap, log.local_maps);
  write_all(channels::kTrack, log.tracks);
  write_all(channels::kPipelineStatus, log.pipeline_status);
  write_all(channels::kAsState, log.as_states);
  write_all(channels::kDriveCommand, log.drive_commands);
  write_all(channels::kVelocity, log.velocities);
  write_all(channels::kConesFusion, log.cones_fusion);
  writer.Close();
}

}  // namespace hairpin
