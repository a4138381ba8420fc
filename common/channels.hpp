#pragma once

#include <cstdint>
#include <string>

#include "hairpin/as_state_t.hpp"
#include "hairpin/cone_clusters_t.hpp"
#include "hairpin/cones_t.hpp"
#include "hairpin/drive_command_t.hpp"
#include "hairpin/global_map_t.hpp"
#include "hairpin/gnss_t.hpp"
#include "hairpin/ground_speed_t.hpp"
#include "hairpin/heartbeat_t.hpp"
#include "hairpin/imu_t.hpp"
#include "hairpin/lidar_scan_t.hpp"
#include "hairpin/local_map_t.hpp"
#include "hairpin/motors_t.hpp"
#include "hairpin/pipeline_status_t.hpp"
#include "hairpin/race_line_t.hpp"
#include "hairpin/steering_t.hpp"
#include "hairpin/track_t.hpp"
#include "hairpin/truth_t.hpp"
#include "hairpin/truth_track_t.hpp"
#include "hairpin/vehicle_t.hpp"
#include "hairpin/velocity_t.hpp"

namespace hairpin {

/// A channel of the car: its name, the message that travels on it, how often it does, and after
/// which time without one it is stale. Code, watchdog, logger and docs read this one table.
template <class M>
struct Channel {
  using Message = M;
  const char* name;
  double rate_hz;     // nominal
  double deadline_s;  // stale when the newest message is older than this, in data time
  bool many_senders = false;
};

namespace channels {

inline constexpr Channel<imu_t> kImu{"IMU", 100.0, 0.05};
inline constexpr Channel<ground_speed_t> kGroundSpeed{"GROUND_SPEED", 100.0, 0.05};
inline constexpr Channel<motors_t> kMotors{"MOTORS", 100.0, 0.05};
inline constexpr Channel<steering_t> kSteering{"STEERING", 100.0, 0.05};
inline constexpr Channel<gnss_t> kGnss{"GNSS", 10.0, 0.25};
inline constexpr Channel<vehicle_t> kVehicle{"VEHICLE", 20.0, 0.2};
inline constexpr Channel<velocity_t> kVelocity{"VELOCITY", 100.0, 0.1};
inline constexpr Channel<lidar_scan_t> kLidarFront{"LIDAR_FRONT", 10.0, 0.25};
inline constexpr Channel<lidar_scan_t> kLidarTop{"LIDAR_TOP", 10.0, 0.25};
inline constexpr Channel<cone_clusters_t> kConeClusters{"CONE_CLUSTERS", 10.0, 0.25};
inline constexpr Channel<cones_t> kConesFusion{"CONES_FUSION", 10.0, 0.25};
inline constexpr Channel<cones_t> kConesLidar{"CONES_LIDAR", 10.0, 0.25};
inline constexpr Channel<cones_t> kConesCamera{"CONES_CAMERA", 10.0, 0.25};
inline constexpr Channel<pipeline_status_t> kPipelineStatus{"PIPELINE_STATUS", 50.0, 0.1};
inline constexpr Channel<local_map_t> kLocalMap{"LOCAL_MAP", 10.0, 0.25};
inline constexpr Channel<global_map_t> kGlobalMap{"GLOBAL_MAP", 10.0, 0.5};
inline constexpr Channel<race_line_t> kRaceLine{"RACE_LINE", 10.0, 0.5};
inline constexpr Channel<track_t> kTrack{"TRACK", 10.0, 0.25};
inline constexpr Channel<as_state_t> kAsState{"AS_STATE", 20.0, 0.2};
inline constexpr Channel<drive_command_t> kDriveCommand{"DRIVE_COMMAND", 100.0, 0.1};
inline constexpr Channel<heartbeat_t> kHeartbeat{"HEARTBEAT", 10.0, 0.5, true};
inline constexpr Channel<truth_t> kTruth{"TRUTH", 100.0, 0.1};
inline constexpr Channel<truth_track_t> kTruthTrack{"TRUTH_TRACK", 0.2, 10.0};

}  // namespace channels

/// Calls `visit(channel)` for every channel of the table, in the order of the data's flow.
template <class Visitor>
void ForEachChannel(Visitor&& visit) {
  visit(channels::kImu);
  visit(channels::kGroundSpeed);
  visit(channels::kMotors);
  visit(channels::kSteering);
  visit(channels::kGnss);
  visit(channels::kVehicle);
  visit(channels::kVelocity);
  visit(channels::kLidarFront);
  visit(channels::kLidarTop);
  visit(channels::kConeClusters);
  visit(channels::kConesFusion);
  visit(channels::kConesLidar);
  visit(channels::kConesCamera);
  visit(channels::kPipelineStatus);
  visit(channels::kLocalMap);
  visit(channels::kGlobalMap);
  visit(channels::kRaceLine);
  visit(channels::kTrack);
  visit(channels::kAsState);
  visit(channels::kDriveCommand);
  visit(channels::kHeartbeat);
  visit(channels::kTruth);
  visit(channels::kTruthTrack);
}

/// One number over the fingerprints of all channels: two daemons that differ in it cannot
/// understand each other.
int64_t TypesHash();

}  // namespace hairpin
