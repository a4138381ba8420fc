#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "common/cone.hpp"
#include "common/geometry.hpp"
#include "common/map_mode.hpp"
#include "hairpin/cones_t.hpp"

namespace hairpin::test {

/// What one pipeline sees of a lane. Defaults: LiDAR and fusion.
struct LaneSensor {
  double half_view = 100.0 * std::numbers::pi / 180.0;  // rad
  double max_range = 22.0;
  std::vector<double> recall_range{0.0, 5.0, 11.0, 14.0, 16.0, 22.0};
  std::vector<double> recall{0.93, 0.93, 0.89, 0.74, 0.39, 0.0};
  double false_positives_per_scan = 0.1;
};

struct LaneWorldParams {
  uint64_t seed = 1;
  double length = 300.0;                   // m
  double half_width = 1.6;                 // m
  double max_heading = 1.3;                // rad; the lane swings between plus and minus this
  double swing_length = 80.0;              // m of lane in one swing to and fro
  double max_speed = 12.0;                 // m/s
  double max_lateral_acceleration = 12.0;  // m/s^2
  double speed_sigma = 0.05;               // m/s, white, of each VELOCITY
  double yaw_rate_sigma = 0.4 * std::numbers::pi / 180.0;  // rad/s, white
  double speed_scale_error = 0.003;
  double yaw_rate_bias = 0.05 * std::numbers::pi / 180.0;  // rad/s
  double delay = 0.1;                                      // s from a scan to its message
  double occlusion_half_width = 0.11;  // m; a nearer cone this close to the line of sight hides
};

/// A car that drives along a winding lane of cones, and what its sensors tell: noisy velocities at
/// 100 Hz, cone messages at 10 Hz and `delay` late. Seeded: the same parameters give the same
/// messages.
///
///     LaneWorld world(params);
///     while (world.Step()) { world.velocity(); world.T_world_base(); for (const Scan& s :
///     world.TakeScans()) ... }
class LaneWorld {
 public:
  struct Cone {
    Eigen::Vector2d position;  // world
    ConeColour colour;
  };
  struct Scan {
    Pipeline pipeline;
    cones_t message;
    Pose2 T_world_base;           // true, at the message's utime
    std::vector<int> true_index;  // of each observation into cones(); -1: false positive
  };

  static constexpr int64_t kStartUtime = 1'000'000'000;
  static constexpr int64_t kStepMicros = 10'000;

  explicit LaneWorld(const LaneWorldParams& params) : params_(params), random_(params.seed) {
    for (double s = 0.0; s <= params_.length + kMargin; s += kCentreStep) {
      centre_.push_back(s == 0.0 ? Pose2{0.0, 0.0, Heading(0.0)} : NextCentre(centre_.back(), s));
    }
    T_world_base_ = At(0.0);
    PlaceCones(params_.half_width, ConeColour::kBlue);
    PlaceCones(-params_.half_width, ConeColour::kYellow);
    for (const double x : {5.0, 5.8}) {
      cones_.push_back(
          {At(x) * Eigen::Vector2d(0.0, params_.half_width + 0.3), ConeColour::kOrangeLarge});
      cones_.push_back(
          {At(x) * Eigen::Vector2d(0.0, -params_.half_width - 0.3), ConeColour::kOrangeLarge});
    }
    LaneSensor camera;
    camera.half_view = 55.0 * std::numbers::pi / 180.0;
    camera.max_range = 20.0;
    camera.recall_range = {0.0, 5.0, 10.0, 14.0, 16.0, 20.0};
    camera.recall = {0.9, 0.9, 0.85, 0.65, 0.3, 0.0};
    sensors_[static_cast<size_t>(Pipeline::kCamera)] = camera;
  }

  /// Ten milliseconds on. False at the end of the lane.
  bool Step() {
    if (s_ > params_.length) return false;
    const double curvature = Curvature(s_);
    const double grip_speed =
        std::sqrt(params_.max_lateral_acceleration / std::max(std::abs(curvature), 1e-3));
    const double speed = std::min(params_.max_speed, grip_speed);
    utime_ += kStepMicros;
    s_ += speed * kStep;
    const Pose2 T_before_now = T_world_base_.Inverse() * At(s_);
    T_world_base_ = At(s_);
    velocity_ = {
        (T_before_now.x / kStep) * (1.0 + params_.speed_scale_error) + Normal(params_.speed_sigma),
        T_before_now.y / kStep + Normal(params_.speed_sigma),
        T_before_now.yaw / kStep + params_.yaw_rate_bias + Normal(params_.yaw_rate_sigma)};
    // The pipelines scan one after another within a cycle.
    const auto phase = static_cast<int>(utime_ / kStepMicros % kStepsPerScan);
    if (phase == 0) Observe(Pipeline::kFusion);
    if (phase == 0) Observe(Pipeline::kLidar);
    if (phase == 3) Observe(Pipeline::kCamera);
    return true;
  }

  int64_t utime() const { return utime_; }
  const Twist2& velocity() const {
    return velocity_;
  }  // measured, mean over the step that ended now
  const Pose2& T_world_base() const { return T_world_base_; }
  const std::vector<Cone>& cones() const { return cones_; }

  /// The scans whose messages arrive now.
  std::vector<Scan> TakeScans() {
    std::vector<Scan> arrived;
    while (!under_way_.empty() &&
           static_cast<double>(utime_ - under_way_.front().message.utime) >= params_.delay * 1e6) {
      arrived.push_back(under_way_.front());
      under_way_.pop_front();
    }
    return arrived;
  }

  LaneSensor& sensor(Pipeline pipeline) { return sensors_[static_cast<size_t>(pipeline)]; }

 private:
  static constexpr double kStep = 1e-6 * static_cast<double>(kStepMicros);
  static constexpr int kStepsPerScan = 10;
  static constexpr double kCentreStep = 0.05;  // m
  static constexpr double kMargin = 30.0;      // m of lane past the end of the drive

  double Heading(double s) const {
    return params_.max_heading * std::sin(2.0 * std::numbers::pi * s / params_.swing_length);
  }
  double Curvature(double s) const { return (Heading(s + 0.1) - Heading(s - 0.1)) / 0.2; }
  Pose2 NextCentre(const Pose2& last, double s) const {
    const double heading = Heading(s - 0.5 * kCentreStep);
    return {last.x + kCentreStep * std::cos(heading), last.y + kCentreStep * std::sin(heading),
            Heading(s)};
  }
  Pose2 At(double s) const {
    const auto i = std::min(static_cast<size_t>(s / kCentreStep), centre_.size() - 2);
    const double share = s / kCentreStep - static_cast<double>(i);
    const Pose2& a = centre_[i];
    const Pose2& b = centre_[i + 1];
    return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.yaw + share * (b.yaw - a.yaw)};
  }

  /// Cones stand closer where the lane turns, down to 1.2 m inside a tight turn.
  void PlaceCones(double offset, ConeColour colour) {
    Eigen::Vector2d last(1e9, 1e9);
    for (double s = 0.0; s < params_.length + kMargin - 1.0; s += kCentreStep) {
      const Eigen::Vector2d position = At(s) * Eigen::Vector2d(0.0, offset);
      const double spacing = std::clamp(4.5 - 35.0 * std::abs(Curvature(s)), 1.2, 4.5);
      if ((position - last).norm() < spacing) continue;
      cones_.push_back({position, colour});
      last = position;
    }
  }

  double Uniform(double min, double max) {
    return std::uniform_real_distribution<double>(min, max)(random_);
  }
  double Normal(double sigma) { return sigma * std::normal_distribution<double>()(random_); }

  static double Interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
    if (at <= x.front()) return y.front();
    if (at >= x.back()) return 0.0;
    const auto i = static_cast<size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
    return y[i - 1] + (at - x[i - 1]) / (x[i] - x[i - 1]) * (y[i] - y[i - 1]);
  }

  void Observe(Pipeline pipeline) {
    const LaneSensor& sensor = sensors_[static_cast<size_t>(pipeline)];
    Scan scan{pipeline, {}, T_world_base_, {}};
    scan.message.utime = utime_;
    const auto half_view = static_cast<float>(sensor.half_view);
    scan.message.sectors = {{-half_view, half_view, static_cast<float>(sensor.max_range)}};
    scan.message.num_sectors = 1;
    std::vector<Eigen::Vector2d> cones_base;
    for (const Cone& cone : cones_) cones_base.push_back(T_world_base_.Inverse() * cone.position);
    for (size_t i = 0; i < cones_.size(); ++i) {
      const double range = cones_base[i].norm();
      if (range > sensor.max_range || !IsVisible(sensor, cones_base, i)) continue;
      if (Uniform(0.0, 1.0) > Interpolate(sensor.recall_range, sensor.recall, range)) continue;
      Add(scan, cones_base[i], cones_[i].colour, static_cast<int>(i));
    }
    const int false_positives =
        std::poisson_distribution<int>(sensor.false_positives_per_scan)(random_);
    for (int i = 0; i < false_positives; ++i) {
      const double range = sensor.max_range * std::sqrt(Uniform(0.05, 1.0));
      const double bearing = Uniform(-sensor.half_view, sensor.half_view);
      Add(scan, range * Eigen::Vector2d(std::cos(bearing), std::sin(bearing)), ConeColour::kUnknown,
          -1);
    }
    scan.message.num_cones = static_cast<int32_t>(scan.message.cones.size());
    under_way_.push_back(std::move(scan));
  }

  bool IsVisible(const LaneSensor& sensor, const std::vector<Eigen::Vector2d>& cones_base,
                 size_t i) const {
    const Eigen::Vector2d& cone = cones_base[i];
    if (std::abs(std::atan2(cone.y(), cone.x())) > sensor.half_view) return false;
    return std::none_of(cones_base.begin(), cones_base.end(), [&](const Eigen::Vector2d& other) {
      const double along = other.dot(cone) / cone.norm();
      const double across = std::abs(cone.x() * other.y() - cone.y() * other.x()) / cone.norm();
      return along > 0.0 && along < cone.norm() - 0.2 && across < params_.occlusion_half_width;
    });
  }

  void Add(Scan& scan, const Eigen::Vector2d& cone_base, ConeColour colour, int true_index) {
    const double range = cone_base.norm();
    const bool camera = scan.pipeline == Pipeline::kCamera;
    const double radial_sigma = camera ? 0.05 * range : 0.04 + 0.004 * range;
    const double lateral_sigma =
        camera ? std::max(0.03, 0.4 * std::numbers::pi / 180.0 * range) : radial_sigma;
    const Pose2 bearing{0.0, 0.0, std::atan2(cone_base.y(), cone_base.x())};
    ConeObservation observation;
    observation.position =
        bearing * Eigen::Vector2d(range + Normal(radial_sigma), Normal(lateral_sigma));
    const Eigen::Vector2d variances(radial_sigma * radial_sigma, lateral_sigma * lateral_sigma);
    observation.covariance = RotateCovariance(variances.asDiagonal(), bearing.yaw);
    observation.colour = ObserveColour(scan.pipeline, colour, range);
    scan.message.cones.push_back(ToMessage(observation));
    scan.true_index.push_back(true_index);
  }

  ColourDistribution ObserveColour(Pipeline pipeline, ConeColour colour, double range) {
    double right = 0.97;
    if (pipeline == Pipeline::kFusion)
      right = std::clamp(0.99 - 0.005 * (range - 10.0), 0.95, 0.99);
    if (pipeline == Pipeline::kLidar) {
      const bool blind =
          range > 12.0 || colour == ConeColour::kOrange || colour == ConeColour::kOrangeLarge;
      if (blind || colour == ConeColour::kUnknown) return {0.9, 0.05, 0.05, 0.0, 0.0};
      right = 0.85;
    }
    if (colour == ConeColour::kUnknown)
      colour = Uniform(0.0, 1.0) < 0.5 ? ConeColour::kBlue : ConeColour::kYellow;
    if (Uniform(0.0, 1.0) > right)
      colour = colour == ConeColour::kBlue ? ConeColour::kYellow : ConeColour::kBlue;
    ColourDistribution distribution{0.05, 0.02, 0.02, 0.02, 0.02};
    distribution[static_cast<size_t>(colour)] += 1.0 - 0.13;
    return distribution;
  }

  LaneWorldParams params_;
  std::mt19937_64 random_;
  std::array<LaneSensor, kNumPipelines> sensors_;
  std::vector<Pose2> centre_;
  std::vector<Cone> cones_;
  double s_ = 0.0;
  int64_t utime_ = kStartUtime;
  Pose2 T_world_base_;
  Twist2 velocity_;
  std::deque<Scan> under_way_;
};

}  // namespace hairpin::test
