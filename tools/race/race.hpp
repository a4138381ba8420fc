#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/race/fault.hpp"
#include "tools/race/stack.hpp"
#include "tools/simulator/simulator.hpp"

namespace hairpin {

inline constexpr const char* kCannelloni = "cannelloni";

struct RaceOptions {
  Track track;
  uint64_t seed = 1;
  bool in_process = false;
  bool attach = false;  // to daemons that run already, instead of starting them
  double speed = 1.0;   // at most this many times real time; 0: as fast as it goes
  /// How long simulated time waits for the answer of a daemon before it counts as dead [s].
  double patience = 0.25;
  std::vector<Fault> faults;
  StackOptions stack;
  /// What the simulated car speaks CAN over, to can_gateway: a CAN interface of the kernel, or
  /// kCannelloni; empty: it does not, unless the sensors are raw. In one process it is memory.
  std::string can;
  std::string log_file;
  /// With raw sensors: what the GNSS receiver sends, as its own recording would hold it; empty:
  /// none.
  std::string receiver_file;
  bool log_scans = false;  // LIDAR_FRONT and LIDAR_TOP too: 12 MB a second
};

struct RaceOutcome {
  RaceResult result;
  std::map<std::string, std::vector<double>> latencies_ms;
  double real_time_factor = 0.0;  // simulated over wall time
  int answers_missed = 0;         // waits of the lock-step that ended without an answer
  bool interrupted = false;
};

/// The sources that a fault may name: the simulator's, and the daemons; `can`: with a gateway.
std::vector<std::string> FaultSources(SensorLevel level = SensorLevel::kCones, bool can = false);

/// Runs simulator and stack until the race is over or `stop` becomes non-zero. Throws ConfigError,
/// or std::runtime_error where a daemon cannot be kept alive.
RaceOutcome RunRace(const RaceOptions& options, const volatile int& stop);

}  // namespace hairpin
