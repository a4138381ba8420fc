#pragma once

#include <array>
#include <cstdint>

#include "common/map_mode.hpp"
#include "daemons/watchdog/event_window.hpp"

namespace hairpin {

/// A truth value for each pipeline, indexed by Pipeline.
using PipelineFlags = std::array<bool, kNumPipelines>;

/// The best mode that these pipelines carry [paper III-C, local map].
MapMode DecideMapMode(bool fusion, bool lidar, bool camera);

struct MapModeSwitchParams {
  int max_flaps = 0;  // falls within the window that are still forgiven
  double flap_window_s = 0.0;
  double health_s = 0.0;  // a fall made good sooner than this was a lost message, not a flap
};

/// The map mode over time: down at once when a pipeline in use goes stale, up when a better one has
/// proved healthy, and latched when it falls too often.
///
/// A flap is the loss of a mode that had been reached by rising, or sideways; a fall that goes on
/// falling is one flap. Once more than `max_flaps` happen within the window, the mode never rises
/// again: it may only fall, or change between LIDAR_ONLY and CAMERA_ONLY, until the watchdog is
/// restarted.
class MapModeSwitch {
 public:
  /// Throws std::invalid_argument for a parameter out of its bounds.
  explicit MapModeSwitch(const MapModeSwitchParams& params);

  /// `fresh`: heard within the deadline. `healthy`: fresh for long enough to be risen to; implies
  /// fresh. `utime` must not decrease.
  void Update(int64_t utime, const PipelineFlags& fresh, const PipelineFlags& healthy);

  MapMode mode() const { return mode_; }
  bool latched() const { return latched_; }

 private:
  void Fall(int64_t utime, const PipelineFlags& fresh);
  void Rise(int64_t utime, MapMode mode);

  MapModeSwitchParams params_;
  EventWindow flaps_;
  MapMode mode_ = MapMode::kNone;
  MapMode fell_from_ = MapMode::kNone;
  int64_t fell_utime_ = 0;
  bool falling_ = false;
  bool latched_ = false;
};

}  // namespace hairpin
