#include "daemons/global_mapper/race_line/race_line.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace hairpin {
namespace {

constexpr double kFarthest = 5.0;  // m: from there on the car is not on this line

}  // namespace

std::vector<RaceLine::Point> Excerpt(const RaceLine& line, const Pose2& T_map_base, double behind,
                                     double ahead) {
  const size_t n = line.points.size();
  const Eigen::Vector2d forward = T_map_base.rotation().col(0);
  double least = kFarthest;
  std::optional<size_t> nearest;
  for (size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d along =
        line.points[(i + 1) % n].position - line.points[(i + n - 1) % n].position;
    const double distance = (line.points[i].position - T_map_base.position()).norm();
    if (distance >= least || along.dot(forward) <= 0.0) continue;
    least = distance;
    nearest = i;
  }
  std::vector<RaceLine::Point> stretch;
  if (!nearest) return stretch;
  const size_t back = std::min(static_cast<size_t>(std::lround(behind / line.spacing)), n / 2);
  const size_t on = std::min(static_cast<size_t>(std::lround(ahead / line.spacing)), n - 1 - back);
  for (size_t i = 0; i <= back + on; ++i)
    stretch.push_back(line.points[(*nearest + n - back + i) % n]);
  return stretch;
}

RaceLine WithSpeeds(const ClosedCurve& curve, const Corridor& corridor,
                    const LapSpeedParams& params) {
  RaceLine line;
  line.spacing = curve.spacing();
  const std::vector<double> speeds = LapSpeeds(curve.curvature(), curve.spacing(), params);
  line.lap_time = LapTime(speeds, curve.spacing());
  for (size_t i = 0; i < curve.size(); ++i) {
    const auto way = corridor.FreeWay(curve.points()[i]);
    line.points.push_back({curve.points()[i], speeds[i], way[0], way[1]});
  }
  return line;
}

RaceLine PlanRaceLine(const std::vector<MappedCone>& cones, const Points& driven,
                      const RaceLineParams& params) {
  const Corridor corridor(cones, driven, params.car, params.corridor);
  return WithSpeeds(MinimumCurvatureLine(corridor, params.line), corridor, params.speed);
}

}  // namespace hairpin
