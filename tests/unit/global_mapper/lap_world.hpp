#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "common/config.hpp"
#include "daemons/global_mapper/global_mapper_node.hpp"

namespace hairpin {

inline GlobalMapperConfig ShippedConfig() {
  return LoadGlobalMapperConfig(
      Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "global_mapper"));
}

/// A car going round a closed track, and the local maps that it makes of it: exact but for the
/// noise of each cone's position, in a frame that drifts.
class LapWorld {
 public:
  struct Drift {
    double scale = 0.0;  // of the distance
    double yaw_rad_per_m = 0.0;
  };

  explicit LapWorld(const Drift& drift, uint64_t seed = 1) : drift_(drift), random_(seed) {
    for (const double x : {6.0, 6.7}) {
      AddCone(x, 1.7, ConeColour::kOrangeLarge);
      AddCone(x, -1.7, ConeColour::kOrangeLarge);
    }
    for (double s = 9.5; s < kLap - 1.5; s += 4.0 + 0.8 * std::sin(s)) {
      AddCone(s, 1.6, ConeColour::kBlue);
      AddCone(s + 0.9, -1.6, ConeColour::kYellow);
    }
  }

  static constexpr double kLap = 160.0;  // m
  static constexpr double kSpeed = 10.0;

  /// Drives `step` m on and returns the local map there.
  LocalMapInput Drive(double step) {
    const Pose2 before = At(driven_);
    driven_ += step;
    const Pose2 motion = before.Inverse() * At(driven_);
    T_local_base_ = T_local_base_ * Pose2{motion.x * (1.0 + drift_.scale), motion.y,
                                          motion.yaw + drift_.yaw_rad_per_m * step};
    utime_ += static_cast<int64_t>(1e6 * std::max(step, 0.1) / kSpeed);
    return See();
  }

  /// local_mapper begins anew: another epoch, pose zero.
  void Restart() {
    epoch_ = utime_;
    T_local_base_ = {};
    tracks_.clear();
  }

  Pose2 T_map_base() const { return At(driven_); }
  int64_t utime() const { return utime_; }
  double driven() const { return driven_; }
  const std::vector<Eigen::Vector2d>& cones() const { return cones_; }
  std::vector<Eigen::Vector2d>& mutable_cones() { return cones_; }

 private:
  struct Track {
    int64_t id = 0;
    double last_seen = 0.0;
    int observations = 0;
  };

  /// The track's middle: a bean, driven from zero along x.
  static Pose2 At(double s) {
    const auto point = [](double t) {
      const double a = 2.0 * std::numbers::pi * t / kLap;
      const double r = kLap / (2.0 * std::numbers::pi);
      return Eigen::Vector2d(r * std::sin(a) * (1.0 + 0.2 * std::cos(a)),
                             r * (1.0 - std::cos(a)) * (1.0 - 0.15 * std::cos(2.0 * a)));
    };
    const Eigen::Vector2d p = point(s) - point(0.0);
    const Eigen::Vector2d d = point(s + 1e-5) - point(s - 1e-5);
    const Eigen::Vector2d d0 = point(1e-5) - point(-1e-5);
    const Pose2 turn{0.0, 0.0, -std::atan2(d0.y(), d0.x())};
    const Eigen::Vector2d q = turn * p;
    return {q.x(), q.y(), WrapAngle(std::atan2(d.y(), d.x()) + turn.yaw)};
  }

  void AddCone(double s, double left, ConeColour colour) {
    cones_.push_back(At(s) * Eigen::Vector2d(0.0, left));
    colours_.push_back(colour);
  }

  LocalMapInput See() {
    LocalMapInput map{utime_, epoch_, T_local_base_, {}};
    std::normal_distribution<double> noise(0.0, 0.03);
    for (size_t c = 0; c < cones_.size(); ++c) {
      const Eigen::Vector2d base = At(driven_).Inverse() * cones_[c];
      if (base.norm() > 14.0 || base.x() < -2.0) continue;
      Track& track = tracks_[c];
      if (track.observations == 0 || driven_ - track.last_seen > 40.0) track = {next_id_++, 0.0, 0};
      track.last_seen = driven_;
      ++track.observations;
      LocalMapCone cone;
      cone.id = track.id;
      cone.seen_now = true;
      cone.position =
          T_local_base_ * Eigen::Vector2d(base.x() + noise(random_), base.y() + noise(random_));
      cone.covariance = 0.0009 * Eigen::Matrix2d::Identity();
      cone.colour = {};
      cone.colour[static_cast<size_t>(colours_[c])] = 0.95;
      cone.colour[0] += 0.05;
      cone.existence = 0.95;
      cone.num_observations = track.observations;
      map.cones.push_back(cone);
    }
    return map;
  }

  Drift drift_;
  std::mt19937_64 random_;
  std::vector<Eigen::Vector2d> cones_;  // map
  std::vector<ConeColour> colours_;
  std::map<size_t, Track> tracks_;
  int64_t next_id_ = 1;
  int64_t epoch_ = 5;
  int64_t utime_ = 1'000'000'000;
  double driven_ = 0.0;
  Pose2 T_local_base_;
};

/// Distance of each map cone from the nearest true one, the worst [m], after the rigid alignment
/// that fits best: how the whole lies in the world is not the map's to know.
inline double WorstError(const GlobalMapEstimate& estimate, const LapWorld& world) {
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pairs;  // mapped, true
  Eigen::Vector2d mapped_mean = Eigen::Vector2d::Zero(), true_mean = Eigen::Vector2d::Zero();
  for (const GlobalCone& cone : estimate.cones) {
    const auto distance = [&cone](const Eigen::Vector2d& p) { return (p - cone.position).norm(); };
    const auto nearest =
        std::min_element(world.cones().begin(), world.cones().end(),
                         [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    pairs.emplace_back(cone.position, *nearest);
    mapped_mean += cone.position / static_cast<double>(estimate.cones.size());
    true_mean += *nearest / static_cast<double>(estimate.cones.size());
  }
  double sine = 0.0, cosine = 0.0;
  for (auto& [mapped, truth] : pairs) {
    mapped -= mapped_mean;
    truth -= true_mean;
    sine += mapped.x() * truth.y() - mapped.y() * truth.x();
    cosine += mapped.dot(truth);
  }
  const Pose2 turn{0.0, 0.0, std::atan2(sine, cosine)};
  double worst = 0.0;
  for (const auto& [mapped, truth] : pairs) worst = std::max(worst, (turn * mapped - truth).norm());
  return worst;
}

}  // namespace hairpin
