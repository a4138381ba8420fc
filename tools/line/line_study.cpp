#include "tools/line/line_study.hpp"

#include <algorithm>
#include <fstream>
#include <limits>

#include "daemons/global_mapper/map_file.hpp"
#include "tools/simulator/track.hpp"
#include "tools/simulator/track_geometry.hpp"

namespace hairpin {
namespace {

constexpr double kMinLap = 100.0;  // m

bool IsMapFile(const std::string& file) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.front() != '#') return line.starts_with("hairpin_map:");
  }
  return false;
}

LineInput FromMap(const MapFile& map) {
  LineInput input;
  input.driven = LapOf(map.driven, kMinLap);
  for (const GlobalCone& cone : map.cones)
    input.cones.push_back({cone.position, MostProbable(cone.colour)});
  return input;
}

LineInput FromTrack(const Track& track) {
  if (!track.closed) throw std::invalid_argument(track.name + " is no lap");
  LineInput input;
  input.driven = CentreLine(track);
  input.driven.pop_back();  // the first again
  for (const auto* cones : {&track.left, &track.right, &track.others}) {
    for (const TrackCone& cone : *cones) input.cones.push_back({cone.position, cone.colour});
  }
  return input;
}

double LengthOf(const RaceLine& line) {
  return line.spacing * static_cast<double>(line.points.size());
}

nlohmann::json Figures(const RaceLine& line, double squared_curvature) {
  return {{"length_m", LengthOf(line)},
          {"lap_time_s", line.lap_time},
          {"mean_speed_mps", LengthOf(line) / line.lap_time},
          {"squared_curvature_per_m", squared_curvature}};
}

}  // namespace

LineInput LoadLineInput(const std::string& file) {
  LineInput input = IsMapFile(file) ? FromMap(LoadMapFile(file)) : FromTrack(LoadTrack(file));
  input.name = file;
  return input;
}

LineStudy StudyLine(const LineInput& input, const RaceLineParams& params) {
  const Corridor corridor(input.cones, input.driven, params.car, params.corridor);
  const ClosedCurve line = MinimumCurvatureLine(corridor, params.line);
  return {input, WithSpeeds(line, corridor, params.speed),
          WithSpeeds(corridor.centre(), corridor, params.speed), line.SquaredCurvature(),
          corridor.centre().SquaredCurvature()};
}

nlohmann::json ToJson(const LineStudy& study) {
  nlohmann::json figures = Figures(study.race, study.race_squared_curvature);
  double fastest = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const RaceLine::Point& point : study.race.points) {
    fastest = std::max(fastest, point.speed);
    least = std::min({least, point.left, point.right});
  }
  figures["name"] = study.input.name;
  figures["max_speed_mps"] = fastest;
  figures["least_free_way_m"] = least;
  figures["middle"] = Figures(study.middle, study.middle_squared_curvature);
  return figures;
}

}  // namespace hairpin
