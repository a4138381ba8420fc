#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemons/global_mapper/race_line/race_line.hpp"

namespace hairpin {

/// What a race line is computed from.
struct LineInput {
  std::string name;
  std::vector<MappedCone> cones;
  Points driven;  // a lap, closed
};

/// Reads a map file of global_mapper, or a track file of any format that the simulator knows (then
/// the middle between its sides stands for the driven line). Throws std::runtime_error with file
/// and reason, std::invalid_argument where the drive in the map is no lap.
LineInput LoadLineInput(const std::string& file);

/// The race line beside the middle of the track, each with the speeds of `params`.
struct LineStudy {
  LineInput input;
  RaceLine race;
  RaceLine middle;
  double race_squared_curvature = 0.0;  // integral over the lap [1/m]
  double middle_squared_curvature = 0.0;
};
LineStudy StudyLine(const LineInput& input, const RaceLineParams& params);

/// Keys: name, length_m, lap_time_s, mean_speed_mps, max_speed_mps, squared_curvature_per_m,
/// least_free_way_m, and middle.{length_m, lap_time_s, mean_speed_mps, squared_curvature_per_m}.
nlohmann::json ToJson(const LineStudy& study);

/// The cones, the middle and the line from above.
std::string DrawLine(const LineStudy& study);

}  // namespace hairpin
