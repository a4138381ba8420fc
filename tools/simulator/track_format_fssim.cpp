#include "tools/simulator/track_draft.hpp"
#include "tools/simulator/track_formats.hpp"

namespace hairpin {

namespace {

constexpr double kFrontWing =
    1.4;  // m ahead of the centre of gravity: the nose of our car (front_overhang_m)

std::vector<LocatedCone> ReadCones(const TrackYaml& list, ConeColour colour) {
  std::vector<LocatedCone> cones;
  for (const TrackYaml& element : list.Elements()) {
    cones.push_back({{element.Point(), colour}, element.line()});
  }
  return cones;
}

/// A side; its file may repeat the first cone at the end to close the lap.
std::vector<LocatedCone> ReadSide(const TrackYaml& list, ConeColour colour) {
  std::vector<LocatedCone> side = ReadCones(list, colour);
  const bool repeats = side.size() > 1 && side.front().cone.position == side.back().cone.position;
  if (repeats) side.pop_back();
  return side;
}

}  // namespace

Track ReadFssimTrack(const TrackYaml& root) {
  TrackDraft draft;
  draft.file = root.file();
  draft.left = ReadSide(root.Get("cones_left"), ConeColour::kBlue);
  draft.right = ReadSide(root.Get("cones_right"), ConeColour::kYellow);
  draft.others = ReadCones(root.Get("cones_orange_big"), ConeColour::kOrangeLarge);
  if (root.Has("cones_orange")) {
    for (const LocatedCone& cone : ReadCones(root.Get("cones_orange"), ConeColour::kOrange)) {
      draft.others.push_back(cone);
    }
  }
  const TrackYaml start = root.Get("starting_pose_front_wing");
  const std::vector<double> wing = start.Numbers(3, 3);
  draft.start_line_number = start.line();
  draft.start = Pose2{wing[0], wing[1], wing[2]} * Pose2{-kFrontWing, 0.0, 0.0};
  if (root.Has("tk_device")) {
    const TrackYaml devices = root.Get("tk_device");
    const std::vector<TrackYaml> posts = devices.Elements();
    if (posts.size() != 2) devices.Refuse("tk_device must be two posts");
    draft.start_gate = LocatedGate{posts[0].Point(), posts[1].Point(), devices.line()};
  }
  JoinSides(draft);
  return Arrange(std::move(draft));
}

}  // namespace hairpin
