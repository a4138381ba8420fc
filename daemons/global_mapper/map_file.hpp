#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/errors.hpp"
#include "common/geometry.hpp"
#include "daemons/global_mapper/map_estimate.hpp"
#include "daemons/global_mapper/start_gate.hpp"

namespace hairpin {

/// A map file that cannot be used: "file:line: reason".
class MapFileError : public InputError {
 public:
  using InputError::InputError;
};

/// A finished map as it lies on disk, in map.
struct MapFile {
  int64_t session = 0;  // boot id of the global_mapper that made it: names the run
  int64_t utime = 0;    // of the local map after which it was written
  int laps = 0;
  Pose2 start;  // T_map_base where the map began
  std::optional<MapGate>
      gate;  // start/finish line; none where no gate of large orange cones is mapped
  std::vector<GlobalCone> cones;
  std::vector<Eigen::Vector2d> driven{};  // the way of base when the map was made, from its start
};

/// YAML for people and machines; positions to 0.1 mm, all the rest too. Written beside `file` and
/// renamed, so that there is never half a map. Throws std::runtime_error where it cannot write.
void SaveMapFile(const MapFile& map, const std::string& file);
std::string ToYaml(const MapFile& map);

/// Strict: a key too many, one missing or a value out of range is an error. Throws MapFileError.
MapFile LoadMapFile(const std::string& file);
MapFile ParseMapFile(const std::string& text, const std::string& file);

}  // namespace hairpin
