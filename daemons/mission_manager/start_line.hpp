#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/geometry.hpp"

namespace hairpin {

/// A line across the track, in any fixed frame [m]: through `centre`, crossed along `direction`
/// (unit length).
struct StartLine {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
  double half_width = 0.0;

  /// How far a point is past the line; negative before it [m].
  double Past(const Eigen::Vector2d& point) const { return direction.dot(point - centre); }
  /// How far it is beside the line's centre [m], never negative.
  double Beside(const Eigen::Vector2d& point) const;
};

/// A cone that may be one of the gate's.
struct GateCone {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double mass = 0.0;  // probability that it exists and is a large orange one
};

struct GateParams {
  double range = 0.0;          // only cones nearer to the car than this [m], > 0
  double min_mass = 0.0;       // of each side, > 0
  double min_cone_mass = 0.0;  // a cone of less mass is another one, > 0
  double min_width = 0.0;      // between the sides' means [m], > 0
  double max_width = 0.0;      // [m], > min_width
};

/// Throws std::invalid_argument for parameters out of their bounds.
void Check(const GateParams& params);

/// The start/finish gate from the large orange cones near the car: the cones fall into two sides,
/// nearest to the one or to the other of the two that are farthest apart; the line goes through the
/// sides' means weighted by mass. Empty where a side lacks mass, or where the gate would be too
/// narrow or too wide. Crossed in the car's direction.
std::optional<StartLine> FindGate(const std::vector<GateCone>& cones, const Pose2& T_frame_base,
                                  const GateParams& params);

/// Notices that the car crosses a line, also while the line's estimate moves about under it.
class CrossingWatch {
 public:
  /// `max_angle` between the car's and the line's direction [rad].
  explicit CrossingWatch(double max_angle) : max_angle_(max_angle) {}

  /// True where the car, after having been before the line, is past it by a little: along its
  /// direction and no more than `tolerance` [m] beside its centre both times.
  bool Crosses(const StartLine& line, const Pose2& T_frame_base, double tolerance);
  void Forget() { approaching_ = false; }

 private:
  double max_angle_;
  bool approaching_ = false;
};

}  // namespace hairpin
