#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemons/watchdog/map_mode_switch.hpp"
#include "daemons/watchdog/source.hpp"

namespace hairpin {

struct WatchdogParams {
  double status_period_s = 0.0;
  double max_time_step_s = 0.0;     // by which one message alone may move data time
  double fusion_speed_cap = 0.0;    // m/s, at level LOG
  double degraded_speed_cap = 0.0;  // m/s, above it
  int max_flaps = 0;
  double flap_window_s = 0.0;
  double lost_after_s = 0.0;  // stale for this long is lost
  double silence_s = 0.0;     // wall time without news
  SourceParams source;
};

/// What the watchdog has to say, as of `utime`.
struct WatchdogStatus {
  int64_t utime = 0;
  MapMode mode = MapMode::kNone;
  Level level = Level::kLog;
  double speed_cap = 0.0;  // m/s
  PipelineFlags fresh{};
  bool latched = false;
  std::string reason;
  std::vector<std::string> culprits;  // names of sources, in the order of the table
};

/// Watches every message of the car, in data time: the newest utime heard on any channel. Decides
/// the map mode and the level of degradation from which sources are stale, doubled, losing messages
/// or late.
///
/// A status is due when data time enters a new cell of the grid of `status_period_s`, and at once
/// when the mode changes or the level rises; it has the utime of the message that caused it.
/// Source: FAULTS 2-6, 14, 17-19, 21-25; DESIGN section 5, "Map modes".
class Watchdog {
 public:
  /// `sources` are the channels, by index in `Hear`; `daemons` the names whose heartbeats are
  /// judged by a spec of their own. Any other daemon is named when it falls silent, at level LOG.
  /// Throws std::invalid_argument for parameters out of bounds and for unknown names in `answers`.
  Watchdog(const WatchdogParams& params, const std::vector<SourceSpec>& sources,
           const std::vector<SourceSpec>& daemons);

  /// A message on the channel `source`. Returns the status if one is due.
  std::optional<WatchdogStatus> Hear(size_t source, const Stamp& stamp);
  /// A heartbeat. Its utime does not move data time: it repeats what the daemon has heard
  /// elsewhere. Returns false where there are too many different names to be true.
  bool HearHeartbeat(const std::string& daemon, const Stamp& stamp);

  /// The status for when data time stands still: mode NONE, controlled stop. Changes nothing.
  WatchdogStatus Silent() const;

  /// True if the last message was put aside, being far ahead of all others: it counts once the next
  /// one agrees.
  bool put_aside() const { return pending_.has_value(); }
  /// Newest utime heard on any channel; 0 before the first.
  int64_t now() const { return now_; }

 private:
  struct Finding {
    const Source* source;
    const char* what;
    Level level;
  };
  struct Pending {
    size_t source;
    Stamp stamp;
  };

  bool MovesTimeTooFar(size_t source, const Stamp& stamp);
  void Take(size_t source, const Stamp& stamp);
  void AwaitAnswers(const SourceSpec& cause);
  std::optional<WatchdogStatus> Step();
  PipelineFlags Flags(bool (Source::*judge)(int64_t) const) const;
  std::optional<Finding> Staleness(const Source& source) const;
  void Inspect(const Source& source, std::vector<Finding>& findings) const;
  std::vector<Finding> Findings() const;
  Level LevelOf(const std::vector<Finding>& findings) const;
  WatchdogStatus StatusOf(const std::vector<Finding>& findings) const;
  std::string ModeReason() const;
  bool IsChannel(const std::string& name) const;

  WatchdogParams params_;
  int64_t status_period_micros_;
  std::vector<Source> sources_;
  std::vector<SourceSpec> daemon_specs_;
  std::map<std::string, Source> daemons_;
  MapModeSwitch mode_;
  int64_t now_ = 0;
  std::optional<Pending> pending_;
  int64_t published_cell_ = -1;
  MapMode published_mode_ = MapMode::kNone;
  Level published_level_ = Level::kEmergency;
};

}  // namespace hairpin
