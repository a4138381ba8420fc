#include "tools/line/line_study.hpp"
#include "tools/report/svg.hpp"
#include "tools/report/view.hpp"

namespace hairpin {
namespace {

Points Closed(const RaceLine& line) {
  Points points;
  for (const RaceLine::Point& point : line.points) points.push_back(point.position);
  points.push_back(points.front());
  return points;
}

}  // namespace

std::string DrawLine(const LineStudy& study) {
  const Points line = Closed(study.race);
  Points all = line;
  for (const MappedCone& cone : study.input.cones) all.push_back(cone.position);
  const View view(all);
  Svg svg(View::kWidth, view.height(), "Race line. " + study.input.name);
  svg.Text({View::kSide, 26.0}, "Race line and middle", "title");
  svg.Text({View::kSide, 44.0},
           study.input.name + ": " + Fixed(study.race.lap_time, 2) + " s on the line, " +
               Fixed(study.middle.lap_time, 2) + " s in the middle",
           "faint");
  svg.Polyline(view(Closed(study.middle)), "boundary of_path");
  svg.Polyline(view(line), "raceline");
  for (const MappedCone& cone : study.input.cones)
    svg.Circle(view(cone.position), 3.2, "rim " + std::string(NameOf(cone.colour)));
  return svg.Standalone();
}

}  // namespace hairpin
