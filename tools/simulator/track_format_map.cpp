#include "tools/simulator/track_draft.hpp"
#include "tools/simulator/track_formats.hpp"

namespace hairpin {

namespace {

LocatedCone ReadCone(const TrackYaml& value) {
  const TrackYaml name = value.Get("colour");
  const auto colour = ConeColourFromName(name.Text());
  if (!colour) name.Refuse("unknown colour: " + name.Text());
  return {{value.Get("position_m").Point(), *colour}, value.line()};
}

}  // namespace

Track ReadMapTrack(const TrackYaml& root) {
  TrackDraft draft;
  draft.file = root.file();
  const TrackYaml start = root.Get("start");
  draft.start_line_number = start.line();
  const std::vector<double> pose = start.Numbers(3, 3);
  draft.start = {pose[0], pose[1], pose[2]};
  // Elements() of null is none.
  const std::vector<TrackYaml> ends = root.Get("finish_line_m").Elements();
  if (!ends.empty() && ends.size() != 2) root.Get("finish_line_m").Refuse("a line has two ends");
  if (ends.size() == 2)
    draft.start_gate = LocatedGate{ends[0].Point(), ends[1].Point(), ends[0].line()};
  for (const TrackYaml& element : root.Get("cones").Elements()) {
    const LocatedCone cone = ReadCone(element);
    const bool left = cone.cone.colour == ConeColour::kBlue;
    const bool right = cone.cone.colour == ConeColour::kYellow;
    (left ? draft.left : right ? draft.right : draft.others).push_back(cone);
  }
  return ArrangeUnordered(std::move(draft));
}

}  // namespace hairpin
