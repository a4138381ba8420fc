#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include "common/geometry.hpp"
#include "daemons/boundary_estimator/boundary_estimator.hpp"

namespace hairpin::test {

using Line = std::vector<Eigen::Vector2d>;

/// A track with truth: its sides and centreline in driving order.
struct SyntheticTrack {
  Line centre;  // closely spaced
  Line left;    // cones
  Line right;
};

/// A piece of constant curvature, positive to the left.
struct Arc {
  double length;
  double curvature = 0.0;
};

/// Cones `spacing` apart along each side of a lane (closer in bends), the right ones half a spacing
/// behind the left ones.
inline SyntheticTrack MakeLane(const std::vector<Arc>& arcs, double width = 3.2,
                               double spacing = 4.0) {
  constexpr double kStep = 0.1;
  SyntheticTrack track;
  Pose2 pose;
  double to_left = 0.0, to_right = 0.5 * spacing;
  for (const Arc& arc : arcs) {
    const double dense = std::abs(arc.curvature) > 0.05 ? 0.7 : 1.0;
    for (double along = 0.0; along < arc.length; along += kStep) {
      track.centre.push_back(pose.position());
      const double grow_left = kStep * (1.0 - arc.curvature * width / 2.0),
                   grow_right = 2.0 * kStep - grow_left;
      if ((to_left -= std::abs(grow_left)) <= 0.0) {
        track.left.push_back(pose * Eigen::Vector2d(0.0, width / 2.0));
        to_left += spacing * dense;
      }
      if ((to_right -= std::abs(grow_right)) <= 0.0) {
        track.right.push_back(pose * Eigen::Vector2d(0.0, -width / 2.0));
        to_right += spacing * dense;
      }
      pose = pose * Integrate({1.0, 0.0, arc.curvature}, kStep);
    }
  }
  return track;
}

/// What a car sees of a track, scan by scan, filtered as a local map filters it: cones missing by
/// range, noise, wrong and unknown colours, false positives.
struct SensorCharacter {
  double wrong_colour_near = 0.01;  // at 10 m and nearer
  double wrong_colour_far = 0.05;   // at 18 m
  double unknown_share = 0.0;       // of the observations
  double false_positives = 0.1;     // a scan
};

class SyntheticMap {
 public:
  SyntheticMap(const SyntheticTrack& track, const SensorCharacter& character, unsigned seed)
      : character_(character), random_(seed) {
    for (const auto& position : track.left) cones_.push_back({position, ConeColour::kBlue});
    for (const auto& position : track.right) cones_.push_back({position, ConeColour::kYellow});
    num_true_ = cones_.size();
  }

  /// One scan from `pose`, and the map after it.
  std::vector<MapCone> Scan(const Pose2& pose) {
    AddFalsePositive(pose);
    const Pose2 T_base_map = pose.Inverse();
    for (size_t i = 0; i < cones_.size(); ++i) Observe(cones_[i], i < num_true_, T_base_map);
    std::vector<MapCone> map;
    for (size_t i = 0; i < cones_.size(); ++i) {
      const Seen& cone = cones_[i];
      if (cone.hits == 0 || cone.log_odds < 0.0) continue;
      MapCone& out = map.emplace_back();
      out.id = static_cast<int64_t>(i) + 1;
      out.position = cone.sum / cone.hits;
      for (size_t k = 0; k < cone.colour.size(); ++k) out.colour[k] = cone.colour[k] / cone.hits;
      out.existence = 1.0 / (1.0 + std::exp(-cone.log_odds));
    }
    return map;
  }

 private:
  struct Seen {
    Eigen::Vector2d truth;
    ConeColour truth_colour;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    ColourDistribution colour{};
    int hits = 0;
    int unseen = 0;
    double log_odds = -0.5;
  };

  static double Recall(double range) {
    const std::pair<double, double> table[] = {
        {5.0, 0.93}, {11.0, 0.89}, {14.0, 0.74}, {16.0, 0.39}, {22.0, 0.0}};
    if (range <= table[0].first) return table[0].second;
    for (size_t i = 1; i < std::size(table); ++i) {
      const auto [r0, p0] = table[i - 1];
      const auto [r1, p1] = table[i];
      if (range < r1) return p0 + (p1 - p0) * (range - r0) / (r1 - r0);
    }
    return 0.0;
  }

  double Uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  double Gauss() { return std::normal_distribution<double>(0.0, 1.0)(random_); }

  void AddFalsePositive(const Pose2& pose) {
    if (Uniform() >= character_.false_positives) return;
    const double range = 3.0 + 15.0 * Uniform(), bearing = (Uniform() - 0.5) * std::numbers::pi;
    const double colour = Uniform();
    Seen phantom{pose * Eigen::Vector2d(range * std::cos(bearing), range * std::sin(bearing)),
                 colour < 0.4   ? ConeColour::kUnknown
                 : colour < 0.7 ? ConeColour::kBlue
                                : ConeColour::kYellow};
    Hit(phantom, range);
    cones_.push_back(phantom);
  }

  void Observe(Seen& cone, bool real, const Pose2& T_base_map) {
    const Eigen::Vector2d position = T_base_map * cone.truth;
    const double range = position.norm();
    const bool in_view = range < 22.0 && std::abs(std::atan2(position.y(), position.x())) < 1.75;
    if (in_view && real && Uniform() < Recall(range)) return Hit(cone, range);
    if (in_view && cone.hits > 0) {
      cone.log_odds -= 1.5 * Recall(range);
    } else if (!in_view && ++cone.unseen > 40) {
      cone.hits = 0;
    }
    if (cone.log_odds < -1.0) cone.hits = 0;
    if (cone.hits == 0) Forget(cone);
  }

  void Forget(Seen& cone) {
    cone.sum.setZero();
    cone.colour = {};
    cone.log_odds = -0.5;
    cone.unseen = 0;
  }

  void Hit(Seen& cone, double range) {
    const double sigma = 0.04 + 0.004 * range;
    cone.sum += cone.truth + sigma * Eigen::Vector2d(Gauss(), Gauss());
    const double far = std::clamp((range - 10.0) / 8.0, 0.0, 1.0);
    const double wrong = character_.wrong_colour_near +
                         far * (character_.wrong_colour_far - character_.wrong_colour_near);
    ConeColour colour = cone.truth_colour;
    if (Uniform() < wrong)
      colour = colour == ConeColour::kBlue ? ConeColour::kYellow : ConeColour::kBlue;
    if (Uniform() < character_.unknown_share) colour = ConeColour::kUnknown;
    for (size_t k = 0; k < cone.colour.size(); ++k)
      cone.colour[k] += k == static_cast<size_t>(colour) ? 0.92 : 0.02;
    cone.log_odds = std::min(cone.log_odds + 1.2, 3.0);
    cone.unseen = 0;
    ++cone.hits;
  }

  SensorCharacter character_;
  std::mt19937 random_;
  std::vector<Seen> cones_;
  size_t num_true_ = 0;
};

/// Length of `path` up to where it first crosses a side of the track; all of it if it does not.
inline double LengthInside(const std::vector<PathPoint>& path, const SyntheticTrack& track) {
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  double done = 0.0;
  for (size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector2d from = path[i - 1].position, step = path[i].position - from;
    double least = 2.0;
    for (const Line* side : {&track.left, &track.right}) {
      for (size_t k = 1; k < side->size(); ++k) {
        const Eigen::Vector2d a = (*side)[k - 1], edge = (*side)[k] - a;
        const double det = cross(step, edge);
        if (det == 0.0 || edge.norm() > 12.0) continue;
        const double t = cross(a - from, edge) / det, u = cross(a - from, step) / det;
        if (t >= 0.0 && t <= 1.0 && u >= 0.0 && u <= 1.0) least = std::min(least, t);
      }
    }
    if (least <= 1.0) return done + least * step.norm();
    done += step.norm();
  }
  return done;
}

/// Middle paths planned while driving along a track.
struct SyntheticResult {
  int paths = 0;
  int full_length = 0;  // reach 15 m
  int none = 0;
  std::vector<int> left_at = std::vector<int>(16, 0);  // paths that leave the track at this metre
  std::vector<std::pair<int, double>> worst;           // frame, metre
};

/// Drives along the track until its end comes into view, a frame each metre, up to 0.8 m beside the
/// centreline and askew by `slide` at most [rad].
inline SyntheticResult DriveAlong(const SyntheticTrack& track,
                                  const BoundaryEstimatorParams& params,
                                  const SensorCharacter& character, double slide, unsigned seed) {
  SyntheticMap map(track, character, seed);
  BoundaryEstimator estimator(params);
  SyntheticResult result;
  const double phase = 0.7 * seed;
  constexpr double kViewAhead = 22.0;
  double driven = -kViewAhead;  // up to where the track ends within view
  for (size_t i = 1; i < track.centre.size(); ++i)
    driven += (track.centre[i] - track.centre[i - 1]).norm();
  double next = 0.0, along = 0.0;
  int frame = 0;
  for (size_t i = 1; i < track.centre.size(); ++i) {
    const Eigen::Vector2d step = track.centre[i] - track.centre[i - 1];
    along += step.norm();
    if (along > driven) break;
    if (along < next || step.isZero()) continue;
    next += 1.0;
    const Pose2 on_centre{track.centre[i].x(), track.centre[i].y(), std::atan2(step.y(), step.x())};
    const Pose2 pose = on_centre * Pose2{0.0, 0.8 * std::sin(along / 9.0 + phase),
                                         slide * std::sin(along / 6.0 + 2.0 * phase)};
    const TrackEstimate estimate = estimator.Estimate(pose, map.Scan(pose));
    ++frame;
    ++result.paths;
    if (!estimate.valid) ++result.none;
    if (estimate.path.length >= 15.0 - 1e-6) ++result.full_length;
    const double inside = LengthInside(estimate.path.points, track);
    if (estimate.valid && inside < std::min(15.99, estimate.path.length) - 1e-6) {
      ++result.left_at[static_cast<size_t>(inside)];
      result.worst.push_back({frame, inside});
    }
  }
  return result;
}

}  // namespace hairpin::test
