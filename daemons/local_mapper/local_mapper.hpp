#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>

#include "common/geometry.hpp"
#include "common/map_mode.hpp"
#include "common/pose_history.hpp"
#include "daemons/local_mapper/local_map.hpp"
#include "daemons/local_mapper/observation.hpp"

namespace hairpin {

/// How far each pipeline's word counts, by what else there is.
struct TrustByMode {
  Trust fusion;
  Trust lidar_only;
  Trust camera_only;
  Trust lidar_beside_camera;
  Trust camera_beside_lidar;

  /// Of a pipeline that `mode` uses.
  const Trust& Of(MapMode mode, Pipeline pipeline) const;
};

struct LocalMapperParams {
  LocalMapParams map;
  TrustByMode trust;
  double history = 0.0;               // s of poses kept; later observations are refused
  double velocity_deadline = 0.0;     // s; a longer gap between velocities is no motion one knows
  double max_velocity_gap = 0.0;      // s; after a longer gap the map begins anew
  double gap_acceleration = 0.0;      // m/s^2, change of acceleration that may hide in a gap
  double gap_yaw_acceleration = 0.0;  // rad/s^2
  double max_speed = 0.0;             // m/s; beyond it a velocity is absurd
  double max_yaw_rate = 0.0;          // rad/s
  double cycle = 0.0;                 // s between two scans of a pipeline
  size_t max_observations = 0;        // in one set

  /// Throws std::invalid_argument naming parameter, relation and bound.
  void Validate() const;
};

/// The local map after one set of observations.
struct LocalMapEstimate {
  int64_t utime = 0;  // of the observations
  int64_t epoch = 0;  // utime of the epoch's first set; ids live within one epoch
  MapMode mode = MapMode::kUnknown;
  Pose2 T_local_base;            // at utime
  std::vector<LocalCone> cones;  // in local
};

/// Dead reckoning, and the decision which observations enter the local map, and at which pose.
/// [paper III-C, local map]
class LocalMapper {
 public:
  /// Throws std::invalid_argument for bad parameters.
  explicit LocalMapper(const LocalMapperParams& params);

  void SetMode(MapMode mode) { mode_ = mode; }

  /// Moves the pose to `utime` by a velocity of base. Returns why it was refused, empty if it was
  /// not. After a gap longer than `velocity_deadline` the covariances grow by what the gap may
  /// hide; after one longer than `max_velocity_gap` everything begins anew: pose zero, empty map,
  /// new epoch.
  std::string_view AddVelocity(int64_t utime, const Twist2& velocity);

  struct Outcome {
    std::optional<LocalMapEstimate> map;  // empty where the set was not used
    std::string_view
        refused;  // why; empty where the set was used or the mode does not use its pipeline
  };
  /// Enters a set of observations at the pose of its own time. Refused are sets without such a pose
  /// (before the history or the last gap, or past the newest velocity), sets seen before, and those
  /// of a scan that has already entered the map through another pipeline.
  Outcome Observe(const ObservationSet& set);

 private:
  void Restart();
  std::string_view WhyRefused(const ObservationSet& set) const;
  bool SharesScan(const ObservationSet& set) const;
  Pose2 PoseOf(const ObservationSet& set);

  LocalMapperParams params_;
  MapMode mode_ = MapMode::kUnknown;
  PoseHistory history_;
  LocalMap map_;
  int64_t whole_since_utime_ = 0;  // the history has no gap since
  int64_t epoch_ = 0;
  Pose2 T_local_odometry_;     // what cones said of the pose so far, beyond the history's
  int64_t refined_utime_ = 0;  // of the newest set that the pose was refined by, 0: none
  Twist2 velocity_;            // newest
  Twist2 refined_velocity_;    // newest at that time
  Eigen::Vector3d hidden_variance_ = Eigen::Vector3d::Zero();  // by gaps since, of (x, y, yaw)
  std::array<std::set<int64_t>, kNumPipelines> used_utimes_;   // within the history, by Pipeline
};

}  // namespace hairpin
