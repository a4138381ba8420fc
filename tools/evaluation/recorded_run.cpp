#include "tools/evaluation/recorded_run.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace hairpin {
namespace {

using nlohmann::json;

// In the order of the lists in the file.
constexpr std::array<ConeColour, 5> kColours{ConeColour::kUnknown, ConeColour::kYellow,
                                             ConeColour::kBlue, ConeColour::kOrange,
                                             ConeColour::kOrangeLarge};

const json& Field(const json& frame, const char* key) {
  if (!frame.is_object()) throw RecordingError("is no object");
  const auto found = frame.find(key);
  if (found == frame.end()) throw RecordingError(std::string(key) + ": is missing");
  return *found;
}

double ReadNumber(const json& value, const std::string& name) {
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    throw RecordingError(name + ": is no finite number");
  return value.get<double>();
}

Eigen::Vector2d ReadPoint(const json& value, const std::string& name) {
  if (!value.is_array() || value.size() != 2) throw RecordingError(name + ": must be [x, y]");
  return {ReadNumber(value[0], name), ReadNumber(value[1], name)};
}

std::vector<MapCone> ReadCones(const json& lists) {
  if (!lists.is_array() || lists.size() != kColours.size())
    throw RecordingError("slam_cones: must be five lists");
  std::vector<MapCone> cones;
  for (size_t colour = 0; colour < kColours.size(); ++colour) {
    const std::string name = "slam_cones[" + std::to_string(colour) + "]";
    if (!lists[colour].is_array()) throw RecordingError(name + ": is no list");
    for (const json& point : lists[colour]) {
      MapCone& cone = cones.emplace_back();
      cone.id = static_cast<int64_t>(cones.size());
      cone.position = ReadPoint(point, name);
      cone.colour.fill(0.0);
      cone.colour[static_cast<size_t>(kColours[colour])] = 1.0;
      cone.existence = 1.0;
    }
  }
  return cones;
}

RecordedFrame ReadFrame(const json& value) {
  RecordedFrame frame;
  const Eigen::Vector2d position = ReadPoint(Field(value, "car_position"), "car_position");
  const Eigen::Vector2d direction = ReadPoint(Field(value, "car_direction"), "car_direction");
  if (direction.isZero()) throw RecordingError("car_direction: is zero");
  frame.T_map_base = {position.x(), position.y(), std::atan2(direction.y(), direction.x())};
  if (value.contains("car_speed")) frame.speed = ReadNumber(value["car_speed"], "car_speed");
  frame.cones = ReadCones(Field(value, "slam_cones"));
  return frame;
}

json Parse(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw RecordingError(file + ": cannot be read");
  try {
    return json::parse(stream);
  } catch (const json::exception& error) {
    throw RecordingError(file + ": no JSON: " + error.what());
  }
}

}  // namespace

std::vector<RecordedFrame> LoadRecordedRun(const std::string& file) {
  const json document = Parse(file);
  if (!document.is_array() || document.empty())
    throw RecordingError(file + ": is no list of frames");
  std::vector<RecordedFrame> run;
  for (const json& frame : document) {
    try {
      run.push_back(ReadFrame(frame));
    } catch (const RecordingError& error) {
      throw RecordingError(file + ": frame " + std::to_string(run.size()) + ": " + error.what());
    }
  }
  return run;
}

}  // namespace hairpin
