#include <map>

#include "tools/simulator/track_draft.hpp"
#include "tools/simulator/track_formats.hpp"

namespace hairpin {

namespace {

constexpr const char* kInvisible = "invisible";
constexpr const char* kTimekeeping = "timekeeping";

LocatedCone ReadCone(const TrackYaml& value) {
  static const std::map<std::string, ConeColour> kClasses{
      {"blue", ConeColour::kBlue},           {"yellow", ConeColour::kYellow},
      {"small-orange", ConeColour::kOrange}, {"big-orange", ConeColour::kOrangeLarge},
      {"unknown", ConeColour::kUnknown},     {kInvisible, ConeColour::kUnknown}};
  const TrackYaml name = value.Get("class");
  const auto known = kClasses.find(name.Text());
  if (known == kClasses.end()) name.Refuse("unknown class: " + name.Text());
  return {{value.Get("position").Point(), known->second}, value.line(), name.Text() != kInvisible};
}

std::vector<LocatedCone> ReadCones(const TrackYaml& list) {
  std::vector<LocatedCone> cones;
  for (const TrackYaml& element : list.Elements()) cones.push_back(ReadCone(element));
  return cones;
}

/// Posts in pairs: the first pair is the start line's, the second an open track's finish.
void ReadTimekeeping(const TrackYaml& list, TrackDraft& draft) {
  std::vector<std::pair<Eigen::Vector2d, int>> posts;
  for (const TrackYaml& element : list.Elements()) {
    const TrackYaml name = element.Get("class");
    if (name.Text() == kInvisible) continue;
    if (name.Text() != kTimekeeping) name.Refuse("unknown class: " + name.Text());
    posts.emplace_back(element.Get("position").Point(), element.line());
  }
  if (posts.size() % 2 != 0) list.Refuse("time_keeping must be pairs of posts");
  const auto pair = [&](size_t i) {
    return LocatedGate{posts[i].first, posts[i + 1].first, posts[i].second};
  };
  if (posts.size() >= 2) draft.start_gate = pair(0);
  if (posts.size() >= 4) draft.finish_gate = pair(2);
}

}  // namespace

Track ReadPacsimTrack(const TrackYaml& root) {
  const TrackYaml track = root.Get("track");
  TrackDraft draft;
  draft.file = root.file();
  draft.closed = track.Get("lanesFirstWithLastConnected").Flag();
  const TrackYaml start = track.Get("start");
  draft.start_line_number = start.line();
  const Eigen::Vector2d position = start.Get("position").Point();
  draft.start = {position.x(), position.y(), start.Get("orientation").Numbers(3, 3)[2]};
  draft.left = ReadCones(track.Get("left"));
  draft.right = ReadCones(track.Get("right"));
  if (track.Has("time_keeping")) ReadTimekeeping(track.Get("time_keeping"), draft);
  if (track.Has("unknown")) {
    for (const LocatedCone& thing : ReadCones(track.Get("unknown"))) {
      if (!thing.marked) continue;
      if (thing.cone.colour == ConeColour::kUnknown) {
        draft.clutter.push_back(thing.cone.position);
      } else {
        draft.others.push_back(thing);
      }
    }
  }
  JoinSides(draft);
  return Arrange(std::move(draft));
}

}  // namespace hairpin
