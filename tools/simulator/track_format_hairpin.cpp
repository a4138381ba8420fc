#include <array>
#include <charconv>
#include <fstream>

#include "tools/simulator/track_draft.hpp"
#include "tools/simulator/track_formats.hpp"

namespace hairpin {

namespace {

constexpr int kVersion = 1;

/// [xx, xy, yy]
Eigen::Matrix2d ReadCovariance(const TrackYaml& list) {
  std::vector<double> values;
  for (const TrackYaml& element : list.Elements()) values.push_back(element.Number());
  if (values.size() != 3) list.Refuse("must be [xx, xy, yy]");
  Eigen::Matrix2d covariance;
  covariance << values[0], values[1], values[1], values[2];
  if (!IsCovariance(covariance)) list.Refuse("is no covariance");
  return covariance;
}

GeodeticPoint ReadOrigin(const TrackYaml& value) {
  value.RefuseOtherKeys({"latitude_deg", "longitude_deg", "height_m"});
  const GeodeticPoint origin{value.Get("latitude_deg").Number(),
                             value.Get("longitude_deg").Number(), value.Get("height_m").Number()};
  if (!IsPlaceOnEarth(origin)) value.Refuse("is no place on Earth");
  return origin;
}

LocatedCone ReadCone(const TrackYaml& value) {
  value.RefuseOtherKeys({"x_m", "y_m", "colour", "covariance_m2"});
  const TrackYaml colour = value.Get("colour");
  const auto known = ConeColourFromName(colour.Text());
  if (!known) colour.Refuse("no such colour: " + colour.Text());
  LocatedCone cone{{{value.Get("x_m").Number(), value.Get("y_m").Number()}, *known}, value.line()};
  if (value.Has("covariance_m2")) cone.cone.covariance = ReadCovariance(value.Get("covariance_m2"));
  return cone;
}

std::vector<LocatedCone> ReadCones(const TrackYaml& list) {
  std::vector<LocatedCone> cones;
  for (const TrackYaml& element : list.Elements()) cones.push_back(ReadCone(element));
  return cones;
}

LocatedGate ReadGate(const TrackYaml& value) {
  value.RefuseOtherKeys({"left_m", "right_m"});
  return {value.Get("left_m").Point(), value.Get("right_m").Point(), value.line()};
}

Pose2 ReadPose(const TrackYaml& value) {
  value.RefuseOtherKeys({"x_m", "y_m", "yaw_rad"});
  return {value.Get("x_m").Number(), value.Get("y_m").Number(), value.Get("yaw_rad").Number()};
}

/// The shortest decimal that reads back as the same number.
std::string Exact(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string Exact(const Eigen::Vector2d& point) {
  std::string text = Exact(point.x());
  text.insert(0, 1, '[');
  return text.append(", ").append(Exact(point.y())).append("]");
}

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted + "\"";
}

void WriteCones(std::ostream& stream, const char* key, const std::vector<TrackCone>& cones) {
  stream << key << ":" << (cones.empty() ? " []" : "") << '\n';
  for (const TrackCone& cone : cones) {
    stream << "  - {x_m: " << Exact(cone.position.x()) << ", y_m: " << Exact(cone.position.y())
           << ", colour: " << NameOf(cone.colour);
    if (cone.covariance) {
      const Eigen::Matrix2d& p = *cone.covariance;
      stream << ", covariance_m2: [" << Exact(p(0, 0)) << ", " << Exact(p(0, 1)) << ", "
             << Exact(p(1, 1)) << "]";
    }
    stream << "}\n";
  }
}

void WriteGate(std::ostream& stream, const char* key, const GateLine& gate) {
  stream << key << ": {left_m: " << Exact(gate.left) << ", right_m: " << Exact(gate.right) << "}\n";
}

void Write(std::ostream& stream, const Track& track) {
  stream << "hairpin_track: " << kVersion
         << "  # format version; positions are x forward, y left in map\n"
         << "name: " << Quoted(track.name) << '\n';
  if (track.origin) {
    stream << "origin: {latitude_deg: " << Exact(track.origin->latitude_deg)
           << ", longitude_deg: " << Exact(track.origin->longitude_deg)
           << ", height_m: " << Exact(track.origin->height_m)
           << "}  # of map, x east and y north\n";
  }
  stream << "closed: " << (track.closed ? "true" : "false") << '\n'
         << "start: {x_m: " << Exact(track.start.x) << ", y_m: " << Exact(track.start.y)
         << ", yaw_rad: " << Exact(track.start.yaw) << "}  # the waiting car's centre of gravity\n";
  WriteGate(stream, "start_line", track.start_line);
  if (!track.closed) WriteGate(stream, "finish_line", track.finish_line);
  stream << "# The sides, in driving order from the start line on.\n";
  WriteCones(stream, "left", track.left);
  WriteCones(stream, "right", track.right);
  WriteCones(stream, "others", track.others);
  stream << "clutter:" << (track.clutter.empty() ? " []" : "") << '\n';
  for (const Eigen::Vector2d& thing : track.clutter) stream << "  - " << Exact(thing) << '\n';
}

}  // namespace

Track ReadHairpinTrack(const TrackYaml& root) {
  root.RefuseOtherKeys({"hairpin_track", "name", "origin", "closed", "start", "start_line",
                        "finish_line", "left", "right", "others", "clutter"});
  const TrackYaml version = root.Get("hairpin_track");
  if (version.Number() != kVersion)
    version.Refuse("format version must be " + std::to_string(kVersion));
  TrackDraft draft;
  draft.file = root.file();
  draft.name = root.Get("name").Text();
  draft.closed = root.Get("closed").Flag();
  draft.start = ReadPose(root.Get("start"));
  draft.start_line_number = root.Get("start").line();
  draft.start_gate = ReadGate(root.Get("start_line"));
  if (draft.closed && root.Has("finish_line")) {
    root.Get("finish_line").Refuse("a closed track finishes at its start line");
  }
  draft.finish_gate = draft.closed ? draft.start_gate : ReadGate(root.Get("finish_line"));
  draft.left = ReadCones(root.Get("left"));
  draft.right = ReadCones(root.Get("right"));
  draft.others = ReadCones(root.Get("others"));
  for (const TrackYaml& thing : root.Get("clutter").Elements())
    draft.clutter.push_back(thing.Point());
  Track track = ShapeOf(draft);
  track.start_line = {draft.start_gate->a, draft.start_gate->b};
  track.finish_line = {draft.finish_gate->a, draft.finish_gate->b};
  if (root.Has("origin")) track.origin = ReadOrigin(root.Get("origin"));
  RefuseIf(FindProblem(track), draft);
  return track;
}

void SaveTrack(const Track& track, const std::string& file) {
  std::ofstream stream(file);
  if (stream) Write(stream, track);
  if (!stream.flush()) throw std::runtime_error(file + ": cannot be written");
}

}  // namespace hairpin
