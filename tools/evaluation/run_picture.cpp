#include "tools/evaluation/run_evaluation.hpp"
#include "tools/report/svg.hpp"
#include "tools/report/view.hpp"

namespace hairpin {

std::string DrawMappedRun(const MappedRun& run, const std::vector<SurveyedCone>& survey) {
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(survey.size());
  for (const SurveyedCone& cone : survey) positions.push_back(cone.position);
  const View view(positions);
  Svg svg(View::kWidth, view.height(), "map of a recorded drive against the survey");
  svg.Polyline(view(run.driven), "ours");
  for (const SurveyedCone& cone : survey)
    svg.Circle(view(cone.position), 3.2, "rim " + std::string(NameOf(cone.colour)));
  for (const ComparedCone& cone : run.comparison.cones) {
    svg.Circle(view(cone.position), cone.match ? 5.4 : 8.0,
               "mapped as_" + std::string(NameOf(cone.colour)) + (cone.match ? "" : " wrong"));
  }
  const MapComparison& map = run.comparison;
  svg.Text({View::kSide, 22.0}, "Mapped cones (rings) against surveyed ones (filled)", "title");
  svg.Text({View::kSide, 40.0},
           "RMSE " + (map.rmse ? Fixed(*map.rmse, 3) + " m" : "not known") + ", matched " +
               std::to_string(map.matched) + ", missed " + std::to_string(map.missed) + ", false " +
               std::to_string(map.false_cones) + ", doubled " + std::to_string(map.doubled),
           "faint");
  return svg.Standalone();
}

}  // namespace hairpin
