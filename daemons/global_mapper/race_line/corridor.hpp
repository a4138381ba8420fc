#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/car.hpp"
#include "common/cone.hpp"
#include "daemons/global_mapper/race_line/closed_curve.hpp"

namespace hairpin {

/// A cone of the finished map; its most probable colour.
struct MappedCone {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // map [m]
  ConeColour colour = ConeColour::kUnknown;
};

struct CorridorParams {
  double spacing = 0.0;           // of the curve that the sides are told by [m], > 0
  double smoothing_length = 0.0;  // of the driven line [m], >= 0
  double max_half_width = 0.0;    // cones farther from the driven line bound nothing [m], > 0
  double clearance = 0.0;         // between the car's body and a line of cones' centres [m], >= 0
};

/// One lap of a drive that began before the start line and went on past it: from the place to the
/// place a lap later where the drive comes nearest to itself, at least `min_lap` metres on; what is
/// left between the two ends is spread over the lap. A drive that ends up to 25 m before its
/// beginning, and leads there, is a lap as it is. `poses` are in map, in the order driven. Throws
/// std::invalid_argument where neither holds: the drive never comes within 3 m of its beginning.
Points LapOf(const Points& poses, double min_lap);

/// What lies between the left and the right cones of a lap, and how much of it a car can use.
///
/// The driven line orders the cones: each belongs to the side on which it lies, at the place of the
/// line that is nearest. Left out: a blue cone on the right or a yellow one on the left (it belongs
/// to another stretch, or its colour is wrong), and a cone that stands more than a metre farther
/// out than its two neighbours say. Between neighbours the boundary is both the straight line
/// between them and the curve parallel to the driven line, whichever is nearer to the car: where a
/// cone is missing at the apex, the straight line would lead over it. No cone, left out or not, is
/// nearer to the car than a boundary may be.
class Corridor {
 public:
  /// `driven`: a lap, closed, in the driving direction [m]. Throws std::invalid_argument for
  /// parameters out of their bounds, a lap that is none, and fewer than three cones on a side.
  Corridor(const std::vector<MappedCone>& cones, const Points& driven, const Car& car,
           const CorridorParams& params);

  /// In the middle between the boundaries.
  const ClosedCurve& centre() const { return *centre_; }
  /// Cones of the left and the right side in driving order [m].
  const std::array<Points, 2>& sides() const { return sides_; }

  /// How far base may move along `normal` (unit, to the left) from `point`, near the arc length `s`
  /// of the centre line, with the car's body along a curve of `curvature` there.
  struct Room {
    double right = 0.0;  // [m], negative: to the right
    double left = 0.0;   // [m], >= right; both of one sign: `point` itself is too near to a side
  };
  Room RoomAt(const Eigen::Vector2d& point, const Eigen::Vector2d& normal, double curvature) const;
  /// Distance of the nearest boundary or cone of each side, left and right [m].
  std::array<double, 2> FreeWay(const Eigen::Vector2d& point) const;

 private:
  struct Segment {
    Eigen::Vector2d from;
    Eigen::Vector2d to;
  };
  using Segments = std::vector<Segment>;
  Segments NearSegments(const Eigen::Vector2d& point, size_t side) const;

  Car car_;
  CorridorParams params_;
  std::array<Points, 2> sides_;
  std::array<Segments, 2> segments_;
  std::optional<ClosedCurve> centre_;
};

/// How far the body of a car reaches out of the curve that base follows, rolling without slip on a
/// circle of `curvature` [1/m]: on the inner side the rear axle's flank, on the outer side the
/// front corner.
struct SweptWidth {
  double inner = 0.0;  // [m]
  double outer = 0.0;  // [m]
};
SweptWidth SweptBy(const Car& car, double curvature);

}  // namespace hairpin
