#include "tools/surveying/survey_track.hpp"

#include <cmath>

#include "tools/simulator/track_draft.hpp"

namespace hairpin {

Track TrackOf(const std::vector<SurveyedPoint>& points, const std::string& name) {
  if (points.empty()) throw TrackError(name + ": no points");
  const LocalEnu plane(points.front().position);
  TrackDraft draft;
  draft.file = name;
  draft.name = name;
  std::optional<Eigen::Vector2d> start, ahead;
  int number = 0;
  for (const SurveyedPoint& point : points) {
    const Eigen::Vector2d position = plane.ToEnu(point.position).head<2>();
    ++number;
    if (point.kind == PointKind::kStart) start = position;
    if (point.kind == PointKind::kAhead) ahead = position;
    const std::optional<ConeColour> colour = ColourOf(point.kind);
    if (!colour) continue;
    LocatedCone cone{{position, *colour}, number};
    cone.cone.covariance = point.sigma.head<2>().cwiseAbs2().asDiagonal();
    const bool is_left = *colour == ConeColour::kBlue;
    const bool is_right = *colour == ConeColour::kYellow;
    (is_left ? draft.left : is_right ? draft.right : draft.others).push_back(cone);
  }
  if (!start || !ahead || (*ahead - *start).norm() < 0.5)
    throw TrackError(name +
                     ": the start, and a point half a metre or more ahead of it, are needed");
  const Eigen::Vector2d forward = *ahead - *start;
  draft.start = {start->x(), start->y(), std::atan2(forward.y(), forward.x())};
  Track track = ArrangeUnordered(std::move(draft));
  track.origin = plane.origin();
  return track;
}

}  // namespace hairpin
