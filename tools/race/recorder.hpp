#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/clock.hpp"
#include "common/transport.hpp"
#include "tools/report/log_writer.hpp"

namespace hairpin {

/// Writes every message to an event log, stamped with the data time that `SetTime` last told, and
/// measures how long each stage takes: wall time from hearing its input to hearing its output of
/// the same utime.
class Recorder {
 public:
  /// LiDAR scans go into the log only with `log_scans`: they are a hundred times all the rest.
  Recorder(Transport& transport, const std::string& log_file, bool log_scans);

  void SetTime(int64_t utime) { utime_ = utime; }
  /// Milliseconds of wall time by stage: "velocity_estimator", "lidar_cone_detector",
  /// "local_mapper", "boundary_estimator", "path_tracker", and "cones_to_track" for the last three
  /// pipeline stages together.
  const std::map<std::string, std::vector<double>>& latencies_ms() const { return latencies_ms_; }
  /// Flushes the log; throws std::runtime_error where it could not be written.
  void Close();

 private:
  void OnMessage(const std::string& channel, const uint8_t* data, size_t size);
  void Measure(const std::string& channel, int64_t message_utime);

  MonotonicClock clock_;
  LogWriter log_;
  bool log_scans_;
  int64_t utime_ = 0;
  struct Heard {
    int64_t utime = 0;
    int64_t wall = 0;
  };
  std::map<std::string, Heard> newest_;
  std::map<std::string, std::vector<double>> latencies_ms_;
  std::shared_ptr<Transport::RawSubscription> subscription_;
};

}  // namespace hairpin
