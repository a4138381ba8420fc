#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemons/mission_manager/clock_check.hpp"
#include "daemons/mission_manager/rate_monitor.hpp"

namespace hairpin {

/// A channel that must run at its rate before the car may be Ready; from the channel table.
struct CheckedChannel {
  std::string name;
  double rate = 0.0;      // [Hz]
  double deadline = 0.0;  // [s]
  bool needed = false;    // else only once it was heard: this car may not have it
  bool measures = false;  // by a clock of its own, with the deadline as its tolerance
};

/// What a daemon says of itself in its heartbeat.
struct DaemonVersion {
  std::string build;
  int64_t types_hash = 0;
  int64_t car_hash = 0;  // of car.yaml; 0: it found none

  bool operator==(const DaemonVersion&) const = default;
};

/// What the computer has left.
struct HostFacts {
  /// For the log [GB]; empty where its folder cannot be looked at.
  std::optional<double> free_disk_gb;
  /// That the kernel gives a socket [kB]; empty where the transport needs none.
  std::optional<double> receive_buffer_kb;
};

struct StartupParams {
  std::vector<CheckedChannel> channels;
  RateMonitorParams rate;
  DaemonVersion version;     // of this daemon
  std::string log_folder;    // where the log is written
  double min_free_disk = 0;  // [GB], >= 0
  double min_buffer = 0;     // [kB], >= 0
};

/// The checks before AS Ready, in this order: every channel at its rate over the whole window, the
/// sensors' clocks, builds and message types equal, room for the log, receive buffers, one car.yaml
/// for all [FAULTS 20, 27, 33, 34, 39].
class StartupChecks {
 public:
  /// Throws std::invalid_argument for parameters out of their bounds.
  explicit StartupChecks(const StartupParams& params);

  /// A message of `utime` has arrived when data time was `now`. Throws std::out_of_range for a
  /// channel that is not checked.
  void HeardChannel(const std::string& channel, int64_t utime, int64_t now);
  void HeardDaemon(const std::string& daemon, const DaemonVersion& version);
  void TakeHost(const HostFacts& host) { host_ = host; }

  /// All that is wrong at data time `now`, each by name, in the order of the checks.
  std::vector<std::string> Problems(int64_t now) const;

 private:
  void AddVersionProblems(std::vector<std::string>& problems) const;
  void AddHostProblems(std::vector<std::string>& problems) const;
  void AddConfigProblems(std::vector<std::string>& problems) const;

  StartupParams params_;
  std::map<std::string, RateMonitor> monitors_;
  ClockCheck clocks_;
  std::map<std::string, DaemonVersion> versions_;  // by daemon
  std::optional<HostFacts> host_;
};

}  // namespace hairpin
