#include "daemons/watchdog/watched_sources.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "common/channels.hpp"

namespace hairpin {
namespace {

template <class M>
SourceSpec Spec(const Channel<M>& channel) {
  SourceSpec spec{channel.name, channel.rate_hz, channel.deadline_s};
  spec.when_sick = Level::kDegrade;
  spec.when_disputed = Level::kControlledStop;
  return spec;
}

// The car goes on without one of them: the velocity filter says so in its covariance, the rest of a
// missing LiDAR or map shows in the pipeline that it feeds.
template <class M>
SourceSpec Sensor(const Channel<M>& channel) {
  return Spec(channel);
}

template <class M>
SourceSpec ConePipeline(const Channel<M>& channel, Pipeline pipeline) {
  SourceSpec spec = Spec(channel);
  spec.pipeline = pipeline;
  return spec;
}

template <class M>
SourceSpec Essential(const Channel<M>& channel, Level level, std::vector<std::string> answers) {
  SourceSpec spec = Spec(channel);
  spec.answers = std::move(answers);
  spec.when_stale = spec.when_lost = level;
  return spec;
}

// May be restarted while the car drives on slowly, on what it has.
template <class M>
SourceSpec Planning(const Channel<M>& channel, std::vector<std::string> answers) {
  SourceSpec spec = Essential(channel, Level::kDegrade, std::move(answers));
  spec.when_lost = Level::kControlledStop;
  return spec;
}

SourceSpec Daemon(const std::string& name, std::vector<std::string> answers = {}) {
  SourceSpec spec{name, channels::kHeartbeat.rate_hz, channels::kHeartbeat.deadline_s};
  spec.answers = std::move(answers);
  spec.when_stale = spec.when_lost = Level::kDegrade;
  spec.when_disputed = Level::kControlledStop;
  return spec;
}

// Its own, heard back: only another publisher on it would be a fault.
SourceSpec OwnStatus() {
  SourceSpec spec = Spec(channels::kPipelineStatus);
  spec.deadline_s = std::numeric_limits<double>::infinity();
  return spec;
}

}  // namespace

std::vector<SourceSpec> WatchedChannels() {
  using namespace channels;
  return {
      Sensor(kImu),
      Sensor(kGroundSpeed),
      Sensor(kMotors),
      Sensor(kSteering),
      Sensor(kGnss),
      Essential(kVehicle, Level::kControlledStop, {}),
      Essential(kVelocity, Level::kControlledStop, {}),
      Sensor(kLidarFront),
      Sensor(kLidarTop),
      Sensor(kConeClusters),
      ConePipeline(kConesFusion, Pipeline::kFusion),
      ConePipeline(kConesLidar, Pipeline::kLidar),
      ConePipeline(kConesCamera, Pipeline::kCamera),
      OwnStatus(),
      Planning(kLocalMap, {kConesFusion.name, kConesLidar.name, kConesCamera.name}),
      Sensor(kGlobalMap),
      Sensor(kRaceLine),
      Planning(kTrack, {kLocalMap.name}),
      Essential(kAsState, Level::kEmergency, {kVehicle.name}),
      Essential(kDriveCommand, Level::kControlledStop, {kVelocity.name}),
  };
}

std::vector<SourceSpec> WatchedDaemons() {
  // boundary_estimator hears nothing but LOCAL_MAP, and sends no heartbeats in data time while
  // there is none.
  return {Daemon("velocity_estimator"), Daemon("local_mapper"),
          Daemon("global_mapper"),      Daemon("boundary_estimator", {channels::kLocalMap.name}),
          Daemon("path_tracker"),       Daemon("mission_manager")};
}

size_t WatchedChannelIndex(std::string_view name) {
  static const std::vector<SourceSpec> watched = WatchedChannels();
  const auto found = std::find_if(watched.begin(), watched.end(),
                                  [name](const SourceSpec& spec) { return spec.name == name; });
  if (found == watched.end()) throw std::out_of_range(std::string(name) + " is not watched");
  return static_cast<size_t>(found - watched.begin());
}

}  // namespace hairpin
