#pragma once

#include "common/geometry.hpp"
#include "daemons/global_mapper/race_line/corridor.hpp"
#include "daemons/global_mapper/race_line/lap_speed.hpp"
#include "daemons/global_mapper/race_line/minimum_curvature.hpp"

namespace hairpin {

struct RaceLineParams {
  Car car;
  CorridorParams corridor;
  MinimumCurvatureParams line;
  LapSpeedParams speed;
};

/// The line to race on, evenly spaced in driving order; the last point is followed by the first.
struct RaceLine {
  struct Point {
    Eigen::Vector2d position;  // map [m]
    double speed = 0.0;        // [m/s]
    double left = 0.0;         // free way to the boundary [m]
    double right = 0.0;
  };
  std::vector<Point> points;
  double spacing = 0.0;   // [m]
  double lap_time = 0.0;  // of a flying lap by the speeds planned [s]
};

/// The part of the line from `behind` [m] behind the car to `ahead` [m] ahead of it, in driving
/// order; of places equally near the one counts that leads the car's way. At most once round.
/// Empty where the line is not within 5 m, or everywhere leads elsewhere.
std::vector<RaceLine::Point> Excerpt(const RaceLine& line, const Pose2& T_map_base, double behind,
                                     double ahead);

/// Between the events: from the cones of a finished map and a lap of the drive that made it
/// (LapOf()) to the line of least curvature and its speeds. Deterministic. Throws
/// std::invalid_argument, with the reason, where there is none.
RaceLine PlanRaceLine(const std::vector<MappedCone>& cones, const Points& driven,
                      const RaceLineParams& params);

/// `line` with its points and speeds for a given curve, free ways by `corridor`.
RaceLine WithSpeeds(const ClosedCurve& curve, const Corridor& corridor,
                    const LapSpeedParams& params);

}  // namespace hairpin
