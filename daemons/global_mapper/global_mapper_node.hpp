#pragma once

#include <optional>

#include "common/bus.hpp"
#include "common/config.hpp"
#include "daemons/global_mapper/global_mapper.hpp"
#include "daemons/global_mapper/map_file.hpp"
#include "daemons/global_mapper/map_store.hpp"
#include "daemons/global_mapper/race_line/race_line.hpp"

namespace hairpin {

struct GlobalMapperConfig {
  GlobalMapperParams params;
  MapStoreParams store;
  std::optional<MapFile> known_map;  // to localise in
  RaceLineParams race_line;
  double race_line_ahead = 0.0;  // m of it that are sent, > 0
};

/// VELOCITY and LOCAL_MAP in; one GLOBAL_MAP for each LOCAL_MAP used, with its utime.
///
/// With a known map the car is localised in it, and RACE_LINE goes before each GLOBAL_MAP that says
/// so; but where VEHICLE selects another mission than the trackdrive, a map is made as without one.
class GlobalMapperNode {
 public:
  GlobalMapperNode(const GlobalMapperConfig& config, Bus& bus);

 private:
  void OnVelocity(const velocity_t& velocity);
  void OnLocalMap(const local_map_t& message);
  /// Begins anew, in the known map or without.
  void Begin(bool localise);
  void PlanRaceLine();
  void Resume(int64_t utime);
  void PublishRaceLine(const GlobalMapEstimate& estimate);

  GlobalMapperConfig config_;
  Bus& bus_;
  std::optional<GlobalMapper> mapper_;
  std::optional<RaceLine> race_line_;
  bool localising_ = false;
  MapStore store_;
  bool resumed_ = false;
};

/// Reads all of global_mapper.yaml. Throws ConfigError.
GlobalMapperConfig LoadGlobalMapperConfig(const Config& config);

}  // namespace hairpin
