#include "tools/simulator/track_formats.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tools/simulator/track_draft.hpp"

namespace hairpin {

namespace {

std::string ReadFile(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  if (!stream || !std::filesystem::is_regular_file(file) || !(text << stream.rdbuf())) {
    RefuseTrack(file, 1, "cannot be read, or is empty");
  }
  return text.str();
}

LoadedTrack ReadYaml(const std::string& text, const std::string& file) {
  const TrackYaml root = TrackYaml::Parse(text, file);
  if (root.Has("hairpin_track")) return {ReadHairpinTrack(root), TrackFormat::kHairpin};
  if (root.Has("hairpin_map")) return {ReadMapTrack(root), TrackFormat::kMap};
  if (root.Has("track")) return {ReadPacsimTrack(root), TrackFormat::kPacsim};
  if (root.Has("cones_left")) return {ReadFssimTrack(root), TrackFormat::kFssim};
  root.Refuse(
      "no track: none of the keys hairpin_track (our own), hairpin_map (a saved map), track "
      "(PacSim), cones_left (FSSIM), "
      "and no EUFS heading `tag,x,y,...`");
}

}  // namespace

std::string_view NameOf(TrackFormat format) {
  switch (format) {
    case TrackFormat::kHairpin:
      return "hairpin YAML";
    case TrackFormat::kMap:
      return "hairpin map";
    case TrackFormat::kPacsim:
      return "PacSim YAML";
    case TrackFormat::kFssim:
      return "FSSIM YAML";
    case TrackFormat::kEufs:
      return "EUFS CSV";
  }
  return "unknown";
}

LoadedTrack LoadTrackOfAnyFormat(const std::string& file) {
  const std::string text = ReadFile(file);
  const bool is_csv = text.starts_with("tag,") || std::filesystem::path(file).extension() == ".csv";
  LoadedTrack loaded =
      is_csv ? LoadedTrack{ReadEufsTrack(text, file), TrackFormat::kEufs} : ReadYaml(text, file);
  if (loaded.track.name.empty()) loaded.track.name = std::filesystem::path(file).stem();
  return loaded;
}

Track LoadTrack(const std::string& file) { return LoadTrackOfAnyFormat(file).track; }

}  // namespace hairpin
