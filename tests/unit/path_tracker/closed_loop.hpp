#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <deque>
#include <fstream>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry.hpp"
#include "daemons/path_tracker/path_tracker.hpp"
#include "daemons/path_tracker/path_tracker_node.hpp"

namespace hairpin::test {

inline PathTrackerParams ShippedParams() {
  return LoadPathTrackerParams(
      Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "path_tracker"));
}

using Points = std::vector<Eigen::Vector2d>;

/// Draws a centreline piece by piece, a point each 0.1 m, from the origin along x.
class PathBuilder {
 public:
  PathBuilder& Straight(double length) { return Arc(length, 0.0); }
  PathBuilder& Arc(double length, double curvature) {
    const int steps = static_cast<int>(std::lround(length / kStep));
    for (int i = 0; i < steps; ++i) {
      pose_ = pose_ * Integrate({kStep, 0.0, kStep * curvature}, 1.0);
      points_.push_back(pose_.position());
    }
    return *this;
  }
  Points Build() const { return points_; }

  static constexpr double kStep = 0.1;

 private:
  Pose2 pose_;
  Points points_{Eigen::Vector2d::Zero()};
};

/// Single-track model with saturating tyres [Rajamani, ch. 2.3], blended into the kinematic one
/// below walking speed, steering with dead time, lag and rate limit, drive force with lag. A
/// stand-in for the car: no controller code in it.
class BicyclePlant {
 public:
  explicit BicyclePlant(const Car& car) : car_(car) {}

  void Step(const TrackerCommand& command, double dt) {
    steering_queue_.push_back(command.steering_angle);
    double angle = 0.0;
    if (steering_queue_.size() > 3) {  // 30 ms at 100 Hz
      angle = steering_queue_.front();
      steering_queue_.pop_front();
    }
    double force = 0.0;
    for (const double torque : command.wheel_torque) force += torque / car_.wheel_radius;
    const double brake = command.brake * car_.max_brake_force;
    constexpr int kSubsteps = 10;
    for (int i = 0; i < kSubsteps; ++i) SubStep(angle, force, brake, dt / kSubsteps);
  }

  Pose2 pose;
  Twist2 twist;
  double lateral_acceleration = 0.0;

 private:
  static double Tyre(double load, double slip) {  // Pacejka's formula with the car's figures
    constexpr double kB = 12.56, kC = 1.38, kD = 1.60, kE = -0.58;
    const double x = kB * slip;
    return load * kD * std::sin(kC * std::atan(x - kE * (x - std::atan(x))));
  }

  void SubStep(double angle, double force, double brake, double dt) {
    constexpr double kSteeringLag = 0.03, kSteeringRate = 4.0, kDriveLag = 0.03, kGravity = 9.81;
    steering_ += std::clamp((angle - steering_) / kSteeringLag, -kSteeringRate, kSteeringRate) * dt;
    force_ += (force - force_) / kDriveLag * dt;
    brake_ += (brake - brake_) / kDriveLag * dt;
    const double L = car_.wheelbase();
    const double vx = twist.vx;
    double ax = (force_ - 0.7 * vx * vx) / car_.mass;
    const double friction = (brake_ + 180.0) / car_.mass;
    const double before = vx + ax * dt;
    double after = before > 0.0 ? std::max(0.0, before - friction * dt)
                                : std::min(0.0, before + friction * dt);
    const double kinematic_rate = vx * std::tan(steering_) / L;
    if (vx < 2.0) {
      twist.yaw_rate = kinematic_rate;
      twist.vy = kinematic_rate * car_.rear_axle;
      lateral_acceleration = vx * kinematic_rate;
    } else {
      const double front_slip =
          steering_ - std::atan2(twist.vy + car_.front_axle * twist.yaw_rate, vx);
      const double rear_slip = -std::atan2(twist.vy - car_.rear_axle * twist.yaw_rate, vx);
      const double front = Tyre(car_.mass * kGravity * car_.rear_axle / L, front_slip);
      const double rear = Tyre(car_.mass * kGravity * car_.front_axle / L, rear_slip);
      lateral_acceleration = (front * std::cos(steering_) + rear) / car_.mass;
      after += (twist.vy * twist.yaw_rate - front * std::sin(steering_) / car_.mass) * dt;
      twist.vy += (lateral_acceleration - vx * twist.yaw_rate) * dt;
      twist.yaw_rate += (car_.front_axle * front * std::cos(steering_) - car_.rear_axle * rear) /
                        car_.yaw_inertia * dt;
    }
    twist.vx = after;
    pose = pose * Integrate(twist, dt);
  }

  Car car_;
  double steering_ = 0.0;
  double force_ = 0.0;
  double brake_ = 0.0;
  std::deque<double> steering_queue_;
};

struct LoopOptions {
  double seen_length = 13.0;  // m of path from the car
  double extrapolated = 3.0;  // m beyond, guessed
  double noise = 0.0;         // of the path's points, standard deviation [m]
  double speed_cap = 12.0;
  bool mirror = false;  // swap left and right in all that goes in
  unsigned seed = 1;
  double path_point_spacing = 0.5;
  bool closed = false;  // the centreline is a lap
};

/// What was seen of a run.
struct LoopSample {
  double t;
  Pose2 pose;
  Twist2 twist;
  TrackerCommand command;
  double s;              // nearest place on the centreline [m]
  double lateral_error;  // true one [m]
  double lateral_acceleration;
};

/// Car, dead reckoning and a perception that shows `seen_length` metres of centreline ten times a
/// second, 0.1 s late, in a local frame of its own.
class ClosedLoop {
 public:
  ClosedLoop(Points centreline, const PathTrackerParams& params, const LoopOptions& options)
      : centreline_(std::move(centreline)),
        options_(options),
        tracker_(params),
        plant(params.car),
        random_(options.seed) {}

  /// One tick of 10 ms.
  LoopSample Step() {
    const int64_t utime = kStart + tick_ * kTick;
    poses_.push_back(plant.pose);
    const double sign = options_.mirror ? -1.0 : 1.0;
    if (supervised) {
      tracker_.TakeAsState({utime, as_driving, mission_finished});
      tracker_.TakePipelineStatus({utime, stop, options_.speed_cap});
    }
    const LoopSample now = Sample();
    if (perceiving && tick_ % 10 == 0 && tick_ >= 10) {
      tracker_.TakePath(Perceive(utime - 10 * kTick, poses_[static_cast<size_t>(tick_ - 10)]));
    }
    const Twist2 twist{plant.twist.vx, sign * plant.twist.vy, sign * plant.twist.yaw_rate};
    command = *tracker_.Answer(utime, velocity_valid ? std::optional(twist) : std::nullopt);
    LoopSample sample = now;
    sample.command = command;
    TrackerCommand actual = command;
    actual.steering_angle *= sign;
    plant.Step(actual, 1e-6 * kTick);
    ++tick_;
    return sample;
  }

  std::vector<LoopSample> Run(double duration) {
    std::vector<LoopSample> samples;
    for (int i = 0; i < static_cast<int>(std::lround(duration * 100.0)); ++i) {
      samples.push_back(Step());
    }
    return samples;
  }

  LoopOptions& options() { return options_; }
  double length() const { return PathBuilder::kStep * static_cast<double>(centreline_.size() - 1); }
  /// Centreline index of the car.
  size_t place() const { return place_; }

 private:
  static constexpr int64_t kStart = 1'700'000'000'000'000;
  static constexpr int64_t kTick = 10'000;

  size_t Nearest(const Pose2& pose, size_t from) const {
    size_t nearest = from;
    for (size_t i = from > 20 ? from - 20 : 0; i < std::min(from + 100, centreline_.size()); ++i) {
      if ((centreline_[i] - pose.position()).norm() <
          (centreline_[nearest] - pose.position()).norm())
        nearest = i;
    }
    return nearest;
  }

  LoopSample Sample() {
    place_ = Nearest(plant.pose, place_);
    const size_t i = std::clamp<size_t>(place_, 1, centreline_.size() - 2);
    const Eigen::Vector2d along = (centreline_[i + 1] - centreline_[i - 1]).normalized();
    const Eigen::Vector2d off = plant.pose.position() - centreline_[i];
    return {1e-6 * static_cast<double>(tick_ * kTick),
            plant.pose,
            plant.twist,
            {},
            PathBuilder::kStep * static_cast<double>(place_),
            along.x() * off.y() - along.y() * off.x(),
            plant.lateral_acceleration};
  }

  PathInput Perceive(int64_t utime, const Pose2& pose) {
    PathInput path;
    path.utime = utime;
    const Pose2 T_local_map{3.0, -7.0, 0.8};  // the mapper's frame is its own
    path.T_local_base = T_local_map * pose;
    const size_t start = Nearest(pose, place_ > 60 ? place_ - 40 : 0);
    const auto stride =
        static_cast<size_t>(std::lround(options_.path_point_spacing / PathBuilder::kStep));
    const auto all = static_cast<size_t>((options_.seen_length + options_.extrapolated) /
                                         options_.path_point_spacing);
    std::normal_distribution<double> noise(0.0, 1.0);
    for (size_t k = 0; k <= all; ++k) {
      const size_t i = start + k * stride;
      if (i >= centreline_.size()) break;
      const double s = static_cast<double>(k) * options_.path_point_spacing;
      Eigen::Vector2d point = centreline_[i];
      point.x() += options_.noise * noise(random_);
      point.y() += options_.noise * noise(random_);
      path.points.push_back(T_local_map * point);
      if (s > options_.seen_length) continue;
      ++path.num_seen;
      path.seen_length = s;
    }
    if (!options_.mirror) return path;
    for (Eigen::Vector2d& point : path.points) point.y() = -point.y();
    path.T_local_base = {path.T_local_base.x, -path.T_local_base.y, -path.T_local_base.yaw};
    return path;
  }

  Points centreline_;
  LoopOptions options_;
  PathTracker tracker_;

 public:
  BicyclePlant plant;
  bool as_driving = true;
  bool mission_finished = false;
  bool supervised = true;  // mission_manager and watchdog speak
  bool stop = false;       // watchdog asks for a controlled stop
  bool perceiving = true;
  bool velocity_valid = true;
  TrackerCommand command;

 private:
  std::mt19937 random_;
  int64_t tick_ = 0;
  size_t place_ = 0;
  std::vector<Pose2> poses_;
};

inline double MaxAbsLateralError(const std::vector<LoopSample>& samples) {
  double most = 0.0;
  for (const LoopSample& sample : samples) most = std::max(most, std::abs(sample.lateral_error));
  return most;
}

inline double MaxSpeed(const std::vector<LoopSample>& samples) {
  double most = 0.0;
  for (const LoopSample& sample : samples) most = std::max(most, sample.twist.vx);
  return most;
}

}  // namespace hairpin::test
