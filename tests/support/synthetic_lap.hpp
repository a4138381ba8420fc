#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "daemons/global_mapper/pose_landmark_graph.hpp"
#include "daemons/global_mapper/track_map.hpp"

namespace hairpin {

/// Laps of 300 m round 150 cones in 600 poses each, with 12,300 sightings a lap (20.5 from each
/// pose): odometry and sightings with noise, associations known.
class SyntheticLap {
 public:
  static constexpr int kPoses = 600;  // a lap
  static constexpr int kCones = 150;
  static constexpr double kOdometryPositionSigma = 0.02;  // m
  static constexpr double kOdometryYawSigma = 0.004;      // rad
  static constexpr double kSightingSigma = 0.1;           // m

  struct Sighting {
    size_t cone;
    LandmarkMeasurement measurement;
  };
  struct Step {
    OdometryMeasurement odometry;  // from the step before
    std::vector<Sighting> sightings;
  };

  explicit SyntheticLap(uint64_t seed, int laps = 1) : random_(seed) {
    for (int i = 0; i < kCones / 2; ++i) {
      const double s = (i + 0.5) / (kCones / 2);
      for (const double side : {2.0, -2.0}) cones_.push_back(At(s) * Eigen::Vector2d(0.0, side));
    }
    Pose2 before = At(0.0);
    for (int i = 0; i < laps * kPoses; ++i) {
      const Pose2 pose = At(static_cast<double>(i) / kPoses);
      poses_.push_back(pose);
      steps_.push_back({MeasureMotion(before.Inverse() * pose), MeasureCones(pose, i)});
      before = pose;
    }
  }

  const std::vector<Step>& steps() const { return steps_; }
  const std::vector<Eigen::Vector2d>& cones() const { return cones_; }
  const std::vector<Pose2>& poses() const { return poses_; }  // map, the first at zero

 private:
  /// A closed curve of 300 m that starts at zero along x: an ellipse-like oval.
  static Pose2 At(double laps) {
    constexpr double kRadius = 300.0 / (2.0 * std::numbers::pi);
    const double a = 2.0 * std::numbers::pi * laps;
    const double wobble = 0.35 * std::sin(3.0 * a);
    const auto point = [&](double b) {
      const double r = kRadius * (1.0 + 0.1 * std::cos(3.0 * b));
      return Eigen::Vector2d(r * std::sin(b), kRadius * 1.1 - r * std::cos(b));
    };
    static_cast<void>(wobble);
    const Eigen::Vector2d d = point(a + 1e-6) - point(a - 1e-6);
    const Eigen::Vector2d p = point(a);
    return {p.x(), p.y(), std::atan2(d.y(), d.x())};
  }

  double Noise(double sigma) { return sigma * normal_(random_); }

  OdometryMeasurement MeasureMotion(const Pose2& T_before_now) {
    OdometryMeasurement measurement;
    measurement.T_from_to = {T_before_now.x + Noise(kOdometryPositionSigma),
                             T_before_now.y + Noise(kOdometryPositionSigma),
                             T_before_now.yaw + Noise(kOdometryYawSigma)};
    const Eigen::Vector3d sigma(kOdometryPositionSigma, kOdometryPositionSigma, kOdometryYawSigma);
    measurement.sqrt_information = sigma.cwiseInverse().asDiagonal();
    return measurement;
  }

  std::vector<Sighting> MeasureCones(const Pose2& pose, int index) {
    // The nearest 20 or 21 cones.
    std::vector<std::pair<double, size_t>> by_distance;
    for (size_t c = 0; c < cones_.size(); ++c)
      by_distance.emplace_back((cones_[c] - pose.position()).norm(), c);
    std::sort(by_distance.begin(), by_distance.end());
    std::vector<Sighting> sightings;
    for (size_t i = 0; i < (index % 2 == 0 ? 20u : 21u); ++i) {
      const size_t cone = by_distance[i].second;
      LandmarkMeasurement measurement;
      measurement.position = pose.Inverse() * cones_[cone] +
                             Eigen::Vector2d(Noise(kSightingSigma), Noise(kSightingSigma));
      measurement.sqrt_information = Eigen::Matrix2d::Identity() / kSightingSigma;
      sightings.push_back({cone, measurement});
    }
    return sightings;
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::vector<Eigen::Vector2d> cones_;
  std::vector<Pose2> poses_;
  std::vector<Step> steps_;
};

/// Feeds the steps of a SyntheticLap into a graph; associations as they truly are.
class SyntheticLapDriver {
 public:
  explicit SyntheticLapDriver(const GraphParams& params, const Pose2& start)
      : graph_(params, start), landmark_of_(SyntheticLap::kCones, kNone) {}

  void Add(const SyntheticLap::Step& step) {
    if (num_steps_++ > 0) graph_.AddPose(step.odometry);
    for (const auto& sighting : step.sightings) {
      size_t& landmark = landmark_of_[sighting.cone];
      if (landmark == kNone)
        landmark = graph_.AddLandmark(graph_.newest_pose() * sighting.measurement.position);
      graph_.AddSighting(landmark, sighting.measurement);
    }
  }
  /// Adds a step and solves as TrackMap does: a window each, everything where the loop closes and
  /// each `full_solve_keyframes` from then on, the oldest marginalised beyond `max_keyframes`.
  /// Returns false where the solver failed.
  bool Drive(const SyntheticLap::Step& step, size_t max_keyframes, size_t full_solve_keyframes) {
    Add(step);
    const bool closed = num_steps_ > SyntheticLap::kPoses;
    const size_t since = num_steps_ - SyntheticLap::kPoses - 1;
    const bool all = closed && since % full_solve_keyframes == 0;
    const bool solved = all ? graph_.SolveAll() : graph_.SolveWindow();
    for (int i = 0; i < kMarginalisedAtOnce && closed && graph_.num_poses() > max_keyframes; ++i)
      graph_.MarginaliseOldest();
    return solved;
  }
  PoseLandmarkGraph& graph() { return graph_; }
  const PoseLandmarkGraph& graph() const { return graph_; }
  Eigen::Vector2d cone(size_t index) const { return graph_.landmark(landmark_of_[index]); }

 private:
  static constexpr size_t kNone = static_cast<size_t>(-1);
  PoseLandmarkGraph graph_;
  std::vector<size_t> landmark_of_;
  size_t num_steps_ = 0;
};

}  // namespace hairpin
