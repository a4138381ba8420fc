#include <array>
#include <iomanip>
#include <sstream>

#include "tools/simulator/track_formats.hpp"

namespace hairpin {

namespace {

// Indexed by ConeColour.
constexpr std::array<const char*, kNumConeColours> kPacsimClasses{"unknown", "blue", "yellow",
                                                                  "small-orange", "big-orange"};
constexpr std::array<const char*, kNumConeColours> kEufsTags{"unknown", "blue", "yellow", "orange",
                                                             "big_orange"};

std::string Place(const Eigen::Vector2d& point) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(4) << "[" << point.x() << ", " << point.y() << ", 0.0]";
  return text.str();
}

void AppendItem(const Eigen::Vector2d& point, const char* name, std::string& text) {
  text += "  - position: " + Place(point) + "\n    class: " + name + "\n";
}

void AppendList(const char* key, const std::vector<TrackCone>& cones, std::string& text) {
  text += std::string("  ") + key + (cones.empty() ? ": []\n" : ":\n");
  for (const TrackCone& cone : cones)
    AppendItem(cone.position, kPacsimClasses[static_cast<size_t>(cone.colour)], text);
}

void AppendRows(const std::vector<TrackCone>& cones, std::ostream& text) {
  for (const TrackCone& cone : cones) {
    text << kEufsTags[static_cast<size_t>(cone.colour)] << ',' << cone.position.x() << ','
         << cone.position.y() << ",0,0.01,0.01,0.0\n";
  }
}

}  // namespace

std::string ToPacsim(const Track& track) {
  std::ostringstream yaw;
  yaw << std::fixed << std::setprecision(6) << track.start.yaw;
  std::string text = "track:\n  version: 1.0\n  lanesFirstWithLastConnected: ";
  text += track.closed ? "true" : "false";
  text += "\n  start:\n    position: " + Place(track.start.position()) +
          "\n    orientation: [0.0, 0.0, " + yaw.str() +
          "]\n  earthToTrack:\n    position: [0.0, 0.0, 0.0]\n    orientation: [0.0, 0.0, 0.0]\n";
  AppendList("left", track.left, text);
  AppendList("right", track.right, text);
  text += "  time_keeping:\n";
  AppendItem(track.start_line.right, "timekeeping", text);
  AppendItem(track.start_line.left, "timekeeping", text);
  if (!track.closed) {
    AppendItem(track.finish_line.right, "timekeeping", text);
    AppendItem(track.finish_line.left, "timekeeping", text);
  }
  std::vector<TrackCone> others = track.others;
  for (const Eigen::Vector2d& thing : track.clutter)
    others.push_back({thing, ConeColour::kUnknown});
  AppendList("unknown", others, text);
  return text;
}

std::string ToEufs(const Track& track) {
  std::ostringstream text;
  text << "tag,x,y,direction,x_variance,y_variance,xy_covariance\n"
       << std::fixed << std::setprecision(4);
  AppendRows(track.left, text);
  AppendRows(track.right, text);
  AppendRows(track.others, text);
  text << "car_start," << track.start.x << ',' << track.start.y << ',' << track.start.yaw
       << ",0.0,0.0,0.0\n";
  return text.str();
}

}  // namespace hairpin
