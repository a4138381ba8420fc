#include "tools/race/recorder.hpp"

#include "common/channels.hpp"

namespace hairpin {
namespace {

struct Stage {
  const char* name;
  std::vector<std::string> inputs;
  const char* output;
};

const std::vector<Stage>& Stages() {
  static const std::vector<std::string> cones{
      channels::kConesFusion.name, channels::kConesLidar.name, channels::kConesCamera.name};
  static const std::vector<Stage> stages{
      {"velocity_estimator", {channels::kImu.name}, channels::kVelocity.name},
      {"lidar_cone_detector",
       {channels::kLidarFront.name, channels::kLidarTop.name},
       channels::kConesLidar.name},
      {"local_mapper", cones, channels::kLocalMap.name},
      {"boundary_estimator", {channels::kLocalMap.name}, channels::kTrack.name},
      {"path_tracker", {channels::kVelocity.name}, channels::kDriveCommand.name},
      {"cones_to_track", cones, channels::kTrack.name},
  };
  return stages;
}

// utime is the first field of every message, behind the 8-byte fingerprint; big-endian.
int64_t UtimeOf(const uint8_t* data, size_t size) {
  if (size < 16) return 0;
  uint64_t utime = 0;
  for (size_t i = 8; i < 16; ++i) utime = utime << 8 | data[i];
  return static_cast<int64_t>(utime);
}

}  // namespace

Recorder::Recorder(Transport& transport, const std::string& log_file, bool log_scans)
    : log_(log_file), log_scans_(log_scans) {
  for (const Stage& stage : Stages()) latencies_ms_[stage.name];
  subscription_ =
      transport.Subscribe(".*", [this](const std::string& channel, const uint8_t* data,
                                       size_t size) { OnMessage(channel, data, size); });
}

void Recorder::OnMessage(const std::string& channel, const uint8_t* data, size_t size) {
  if (channel == "LCM_SELF_TEST") return;  // LCM's own, at the start of a udpm provider
  const bool is_scan = channel == channels::kLidarFront.name || channel == channels::kLidarTop.name;
  if (!is_scan || log_scans_) log_.Write(utime_, channel, data, size);
  Measure(channel, UtimeOf(data, size));
}

void Recorder::Measure(const std::string& channel, int64_t message_utime) {
  const int64_t now = clock_.NowMicros();
  newest_[channel] = {message_utime, now};
  for (const Stage& stage : Stages()) {
    if (channel != stage.output) continue;
    for (const std::string& input : stage.inputs) {
      const auto cause = newest_.find(input);
      if (cause == newest_.end() || cause->second.utime != message_utime) continue;
      latencies_ms_[stage.name].push_back(static_cast<double>(now - cause->second.wall) * 1e-3);
      break;
    }
  }
}

void Recorder::Close() { log_.Close(); }

}  // namespace hairpin
