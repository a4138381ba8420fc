#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "daemons/watchdog/watchdog.hpp"
#include "daemons/watchdog/watched_sources.hpp"

namespace hairpin {

inline WatchdogParams TestWatchdogParams() {
  WatchdogParams params;
  params.status_period_s = 0.02;
  params.max_time_step_s = 0.05;
  params.fusion_speed_cap = 30.0;
  params.degraded_speed_cap = 5.0;
  params.max_flaps = 3;
  params.flap_window_s = 10.0;
  params.lost_after_s = 1.0;
  params.silence_s = 0.5;
  params.source.health_s = 1.0;
  params.source.max_late_in_a_row = 3;
  params.source.tolerated_loss = 0.05;
  params.source.degrading_loss = 0.2;
  params.source.loss_evidence = 10.0;
  params.source.second_publisher_returns = 3;
  params.source.second_publisher_window_s = 5.0;
  params.source.restart_loop_restarts = 5;
  params.source.restart_loop_window_s = 10.0;
  return params;
}

/// The messages of a healthy car as the watchdog hears them: sensors, velocity and commands at 100
/// Hz, pipelines at 10 Hz and 100 ms late, heartbeats at 10 Hz; any of them switched off, lossy or
/// doubled.
class Traffic {
 public:
  static constexpr int64_t kStart = 1'700'000'000'000'000;
  static constexpr int64_t kTick = 10'000;
  static constexpr int64_t kDelay = 100'000;

  /// `offset` [us] of every message from the watchdog's grid.
  explicit Traffic(int64_t offset = 0)
      : watchdog(TestWatchdogParams(), WatchedChannels(), WatchedDaemons()),
        start(kStart + offset),
        now(start) {}

  /// Runs until `seconds` after the start, and returns the statuses of this stretch.
  std::vector<WatchdogStatus> RunTo(double seconds) {
    const size_t first = statuses.size();
    for (const int64_t end = start + std::llround(seconds * 1e6); now < end;) {
      now += kTick;
      Tick();
    }
    return {statuses.begin() + static_cast<std::ptrdiff_t>(first), statuses.end()};
  }

  void Send(const std::string& channel, int64_t utime) {
    if (off.contains(channel)) return;
    const int64_t sequence = sequences[channel]++;
    if (lost && lost(channel)) return;
    SendAs(channel, {utime, boots.contains(channel) ? boots[channel] : 1, sequence});
  }

  void SendAs(const std::string& channel, const Stamp& stamp) {
    if (const auto status = watchdog.Hear(WatchedChannelIndex(channel), stamp))
      statuses.push_back(*status);
  }

  void Tick() {
    for (const char* channel :
         {"MOTORS", "STEERING", "GROUND_SPEED", "IMU", "VELOCITY", "DRIVE_COMMAND"})
      Send(channel, now);
    const int64_t cycle = (now - start) % 100'000;
    if (cycle % 50'000 == 0) {
      Send("VEHICLE", now);
      Send("AS_STATE", now);
    }
    if (cycle != 0) return;
    Send("GNSS", now);
    for (const char* channel :
         {"CONES_FUSION", "CONES_LIDAR", "CONES_CAMERA", "LOCAL_MAP", "TRACK"})
      Send(channel, now - kDelay);
    for (const char* daemon : {"velocity_estimator", "local_mapper", "boundary_estimator",
                               "path_tracker", "mission_manager", "global_mapper"}) {
      Heartbeat(daemon);
    }
  }

  void Heartbeat(const std::string& daemon, int64_t boot_id = 1) {
    if (off.contains(daemon)) return;
    watchdog.HearHeartbeat(daemon, {now, boot_id, sequences[daemon]++});
  }

  Watchdog watchdog;
  std::vector<WatchdogStatus> statuses;
  std::set<std::string> off;
  std::map<std::string, int64_t> boots;
  std::map<std::string, int64_t> sequences;
  std::function<bool(const std::string&)> lost;
  int64_t start;
  int64_t now;
};

/// A car that has nothing to complain of.
inline const auto kHealthy =
    testing::AllOf(testing::Field(&WatchdogStatus::mode, MapMode::kFusion),
                   testing::Field(&WatchdogStatus::level, Level::kLog),
                   testing::Field(&WatchdogStatus::speed_cap, 30.0),
                   testing::Field(&WatchdogStatus::culprits, testing::IsEmpty()),
                   testing::Field(&WatchdogStatus::reason, "healthy"));

// The first status of `statuses` for which `holds`; its utime is 0 where there is none.
template <class Predicate>
WatchdogStatus First(const std::vector<WatchdogStatus>& statuses, Predicate holds) {
  const auto found = std::find_if(statuses.begin(), statuses.end(), holds);
  return found == statuses.end() ? WatchdogStatus{} : *found;
}

}  // namespace hairpin
