#pragma once

#include "common/bus.hpp"
#include "common/clock.hpp"
#include "common/config.hpp"
#include "daemons/watchdog/silence_timer.hpp"
#include "daemons/watchdog/watchdog.hpp"

namespace hairpin {

/// Reads `watchdog.yaml`.
WatchdogParams LoadWatchdogParams(const Config& config);

/// Hears every channel of the car but the simulator's truth, and publishes PIPELINE_STATUS.
class WatchdogNode {
 public:
  /// `clock` is a monotonic wall clock; it must outlive the node, as `bus` must. Throws as Watchdog
  /// does.
  WatchdogNode(const WatchdogParams& params, Bus& bus, const Clock& clock);
  WatchdogNode(const WatchdogNode&) = delete;
  WatchdogNode& operator=(const WatchdogNode&) = delete;

  /// To be called each 10 ms or so: publishes mode NONE and a controlled stop while data time
  /// stands still for longer than `silence_s` of wall time.
  void Poll();

 private:
  template <class M>
  void Listen(const Channel<M>& channel, size_t source);
  void ListenToHeartbeats();
  void Publish(const WatchdogStatus& status);

  Bus& bus_;
  const Clock& clock_;
  Watchdog watchdog_;
  SilenceTimer silence_;
};

}  // namespace hairpin
