#include "daemons/global_mapper/map_file.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <set>
#include <sstream>

namespace hairpin {
namespace {

constexpr int kVersion = 1;
constexpr double kMaxCoordinate = 1e5;  // m
constexpr size_t kMaxCones = 5000;
constexpr size_t kMaxDriven = 20000;

std::string Pair(const Eigen::Vector2d& point) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(4) << '[' << point.x() << ", " << point.y() << ']';
  return text.str();
}

void WriteCone(const GlobalCone& cone, std::ostream& out) {
  const Eigen::Matrix2d& P = cone.covariance;
  out << "  - {id: " << cone.id << ", position_m: " << Pair(cone.position)
      << ", colour: " << NameOf(MostProbable(cone.colour)) << std::scientific
      << std::setprecision(4) << ", covariance_m2: [" << P(0, 0) << ", " << P(0, 1) << ", "
      << P(1, 1) << "]" << std::fixed << std::setprecision(4) << ", probability: [";
  for (size_t i = 0; i < cone.colour.size(); ++i) out << (i == 0 ? "" : ", ") << cone.colour[i];
  out << "], observations: " << cone.num_observations << "}\n";
}

/// Reads with the place of each problem.
class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  [[noreturn]] void Refuse(const YAML::Node& node, const std::string& reason) const {
    const int line = node.Mark().line >= 0 ? node.Mark().line + 1 : 1;
    throw MapFileError(file_ + ":" + std::to_string(line) + ": " + reason);
  }

  void RequireKeys(const YAML::Node& node, const std::set<std::string>& keys) const {
    if (!node.IsMap()) Refuse(node, "not a mapping");
    std::set<std::string> found;
    for (const auto& entry : node) {
      const auto key = entry.first.as<std::string>();
      if (!keys.contains(key)) Refuse(entry.first, "unknown key `" + key + "`");
      if (!found.insert(key).second) Refuse(entry.first, "key `" + key + "` stands twice");
    }
    for (const std::string& key : keys) {
      if (!found.contains(key)) Refuse(node, "key `" + key + "` is missing");
    }
  }

  template <class T>
  T Value(const YAML::Node& node, const std::string& what) const {
    try {
      return node.as<T>();
    } catch (const YAML::Exception&) {
      Refuse(node, what + " is not what it should be");
    }
  }

  std::vector<double> Numbers(const YAML::Node& node, size_t size, const std::string& what,
                              double limit) const {
    auto numbers = Value<std::vector<double>>(node, what);
    if (numbers.size() != size) Refuse(node, what + " has " + std::to_string(size) + " numbers");
    for (const double number : numbers) {
      if (!std::isfinite(number) || std::abs(number) > limit)
        Refuse(node, what + " is out of range");
    }
    return numbers;
  }

  Eigen::Vector2d Point(const YAML::Node& node, const std::string& what) const {
    const auto numbers = Numbers(node, 2, what, kMaxCoordinate);
    return {numbers[0], numbers[1]};
  }

  GlobalCone Cone(const YAML::Node& node) const {
    RequireKeys(node,
                {"id", "position_m", "colour", "covariance_m2", "probability", "observations"});
    GlobalCone cone;
    cone.id = Value<int64_t>(node["id"], "id");
    cone.position = Point(node["position_m"], "position_m");
    const auto P = Numbers(node["covariance_m2"], 3, "covariance_m2", kMaxCoordinate);
    cone.covariance << P[0], P[1], P[1], P[2];
    if (!IsCovariance(cone.covariance))
      Refuse(node["covariance_m2"], "covariance_m2 is not positive definite");
    const auto weights = Numbers(node["probability"], kNumConeColours, "probability", 1.0);
    ColourDistribution distribution;
    std::copy(weights.begin(), weights.end(), distribution.begin());
    const auto colour = Normalised(distribution);
    if (!colour) Refuse(node["probability"], "probability is no distribution");
    cone.colour = *colour;
    if (!ConeColourFromName(Value<std::string>(node["colour"], "colour")))
      Refuse(node["colour"], "no such colour");
    cone.num_observations = Value<int>(node["observations"], "observations");
    return cone;
  }

 private:
  std::string file_;
};

}  // namespace

std::string ToYaml(const MapFile& map) {
  std::ostringstream out;
  out << "# A track as global_mapper mapped it. Frame: map, the car's pose where the mapping began "
         "is `start`.\n"
      << "hairpin_map: " << kVersion << "\nsession: " << map.session << "\nutime: " << map.utime
      << "\nlaps: " << map.laps << std::fixed << std::setprecision(4) << "\nstart: [" << map.start.x
      << ", " << map.start.y << ", " << map.start.yaw << "]  # x_m, y_m, yaw_rad\n"
      << "finish_line_m: ";
  if (map.gate) {
    out << "[" << Pair(map.gate->left) << ", " << Pair(map.gate->right) << "]  # left, right end\n";
  } else {
    out << "null  # no gate of large orange cones was mapped\n";
  }
  out << "# positions of the car, in driving order\ndriven_m:";
  if (map.driven.empty()) out << " []";
  for (const Eigen::Vector2d& point : map.driven) out << "\n  - " << Pair(point);
  out << "\n# probability: unknown, blue, yellow, orange, orange_large; covariance: xx, xy, "
         "yy\ncones:\n";
  for (const GlobalCone& cone : map.cones) WriteCone(cone, out);
  return out.str();
}

void SaveMapFile(const MapFile& map, const std::string& file) {
  const std::string beside = file + ".new";
  {
    std::ofstream stream(beside, std::ios::binary | std::ios::trunc);
    stream << ToYaml(map);
    if (!stream.flush()) throw std::runtime_error(beside + ": cannot be written");
  }
  std::error_code error;
  std::filesystem::rename(beside, file, error);
  if (error) throw std::runtime_error(file + ": " + error.message());
}

MapFile LoadMapFile(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw MapFileError(file + ": cannot be read");
  std::ostringstream text;
  text << stream.rdbuf();
  return ParseMapFile(text.str(), file);
}

MapFile ParseMapFile(const std::string& text, const std::string& file) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw MapFileError(file + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
  const Reader reader(file);
  reader.RequireKeys(root, {"hairpin_map", "session", "utime", "laps", "start", "finish_line_m",
                            "driven_m", "cones"});
  if (reader.Value<int>(root["hairpin_map"], "hairpin_map") != kVersion)
    reader.Refuse(root["hairpin_map"], "another version of the format");
  MapFile map;
  map.session = reader.Value<int64_t>(root["session"], "session");
  map.utime = reader.Value<int64_t>(root["utime"], "utime");
  map.laps = reader.Value<int>(root["laps"], "laps");
  const auto start = reader.Numbers(root["start"], 3, "start", kMaxCoordinate);
  map.start = {start[0], start[1], WrapAngle(start[2])};
  const YAML::Node line = root["finish_line_m"];
  if (!line.IsNull()) {
    if (!line.IsSequence() || line.size() != 2) reader.Refuse(line, "finish_line_m has two ends");
    map.gate =
        MapGate{reader.Point(line[0], "finish_line_m"), reader.Point(line[1], "finish_line_m")};
  }
  const YAML::Node driven = root["driven_m"];
  if (!driven.IsSequence() || driven.size() > kMaxDriven)
    reader.Refuse(driven, "driven_m is no list, or too long");
  for (const auto& point : driven) map.driven.push_back(reader.Point(point, "driven_m"));
  const YAML::Node cones = root["cones"];
  if (!cones.IsSequence() || cones.size() > kMaxCones)
    reader.Refuse(cones, "cones is no list, or too long");
  for (const auto& cone : cones) map.cones.push_back(reader.Cone(cone));
  return map;
}

}  // namespace hairpin
