#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "daemons/global_mapper/localiser.hpp"
#include "daemons/global_mapper/map_estimate.hpp"
#include "daemons/global_mapper/map_record.hpp"
#include "daemons/global_mapper/odometry.hpp"
#include "daemons/global_mapper/start_gate.hpp"
#include "daemons/global_mapper/track_map.hpp"

namespace hairpin {

struct GlobalMapperParams {
  TrackMapParams map;
  LocaliserParams localiser;
  OdometryParams odometry;
  double min_lap_distance = 0.0;  // m driven between two crossings of the start line, > 0

  /// Throws std::invalid_argument naming parameter, relation and bound.
  void Validate() const;
};

/// A finished map, as it was saved: cones, and about where a car starts in it.
struct KnownMap {
  std::vector<GlobalCone> cones;
  Pose2 start;
};

/// The global map from local maps and velocities, or the car's place in one that is known already.
/// Its frame is base at the first local map, or the known map's. [paper III-C, global map]
class GlobalMapper {
 public:
  /// Throws std::invalid_argument for bad parameters.
  explicit GlobalMapper(const GlobalMapperParams& params);
  /// Localises in `known` instead of mapping.
  GlobalMapper(const GlobalMapperParams& params, const KnownMap& known);

  /// Returns why it was refused, empty if it was not.
  std::string_view AddVelocity(int64_t utime, const Twist2& velocity,
                               const Eigen::Matrix3d& covariance);

  struct Outcome {
    std::optional<GlobalMapEstimate> estimate;
    std::vector<MapRecord> records;  // for Replay() in a later life
    std::string_view refused;        // why; empty where it was used
    // Where a lap was finished and the map is settled: positions of the lap's keyframes and of some
    // before, in driving order, map [m].
    std::vector<Eigen::Vector2d> driven{};
  };
  /// Every local map gives an estimate; those that stand far enough from the last keyframe become
  /// one.
  Outcome AddLocalMap(const LocalMapInput& map);

  /// Rebuilds the map from what was recorded of it, or the place in the known one, before anything
  /// else comes in.
  void Replay(const std::vector<MapRecord>& records);

  bool localising() const { return localiser_.has_value(); }

 private:
  struct Seen {
    int64_t utime = 0;
    int64_t epoch = 0;
    Pose2 T_local_base;
  };
  Motion MotionSince(const Seen& before, const LocalMapInput& map) const;
  Outcome Localise(const LocalMapInput& map);
  void EndEpoch(const LocalMapInput& next, Outcome& outcome);
  LocalMapInput Caught(const LocalMapInput& map) const;
  void Resume(const PlaceRecord& place);
  Outcome Map(const LocalMapInput& map);
  GlobalMapEstimate Estimate(const LocalMapInput& map, const Pose2& T_map_base) const;
  void FinishLap(Outcome& outcome);
  void CountLapsOfMap(bool was_closed, const Pose2& T_map_base, double odometer,
                      const std::vector<GlobalCone>& cones);
  void CountLaps(const Pose2& T_map_base, double odometer, const std::vector<GlobalCone>& cones);

  GlobalMapperParams params_;
  VelocityOdometry odometry_;
  TrackMap map_;
  std::optional<Localiser> localiser_;
  std::optional<Seen> last_;               // local map
  std::optional<Seen> keyframe_;           // local map of the last keyframe
  std::optional<LocalMapInput> last_map_;  // the whole of it, while mapping
  std::optional<double> past_gate_;
  double odometer_ = 0.0;
  double lap_odometer_ = 0.0;
  int laps_ = 0;            // times that the start line was crossed with the loop closed
  int finished_laps_ = 0;   // those whose map was told
  double lap_began_ = 0.0;  // the first that was not told, on the odometer [m]
};

}  // namespace hairpin
