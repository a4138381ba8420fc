#include "daemons/watchdog/watchdog_node.hpp"

#include <string_view>
#include <type_traits>

#include "daemons/watchdog/watched_sources.hpp"

namespace hairpin {
namespace {

constexpr size_t kMaxNameLength = 64;

bool IsTruth(std::string_view channel) {
  return channel == channels::kTruth.name || channel == channels::kTruthTrack.name;
}

pipeline_status_t ToMessage(const WatchdogStatus& status) {
  pipeline_status_t message{};
  message.utime = status.utime;
  message.map_mode = static_cast<int32_t>(status.mode);
  message.level = static_cast<int32_t>(status.level);
  message.speed_cap_mps = status.speed_cap;
  message.fusion_fresh = status.fresh[static_cast<size_t>(Pipeline::kFusion)];
  message.lidar_fresh = status.fresh[static_cast<size_t>(Pipeline::kLidar)];
  message.camera_fresh = status.fresh[static_cast<size_t>(Pipeline::kCamera)];
  message.latched = status.latched;
  message.reason = status.reason;
  message.culprits = status.culprits;
  message.num_culprits = static_cast<int32_t>(status.culprits.size());
  return message;
}

}  // namespace

WatchdogParams LoadWatchdogParams(const Config& config) {
  WatchdogParams params;
  params.status_period_s = config.Number("status_period_s", {0.001, 0.1});
  params.max_time_step_s = config.Number("max_time_step_s", {0.01, 1.0});
  params.degraded_speed_cap = config.Number("degraded_speed_cap_mps", {0.5, 40.0});
  params.fusion_speed_cap =
      config.Number("fusion_speed_cap_mps", {params.degraded_speed_cap, 40.0});
  params.max_flaps = config.Integer("max_flaps", 0, 100);
  params.flap_window_s = config.Number("flap_window_s", {1.0, 600.0});
  params.lost_after_s = config.Number("lost_after_s", {0.1, 10.0});
  params.silence_s = config.Number("silence_s", {0.1, 10.0});
  params.source.health_s = config.Number("health_s", {0.1, 60.0});
  params.source.max_late_in_a_row = config.Integer("max_late_in_a_row", 0, 100);
  params.source.tolerated_loss = config.Number("tolerated_loss", {0.001, 0.5});
  params.source.degrading_loss =
      config.Number("degrading_loss", {params.source.tolerated_loss + 0.001, 0.9});
  params.source.loss_evidence = config.Number("loss_evidence", {1.0, 100.0});
  params.source.second_publisher_returns = config.Integer("second_publisher_returns", 1, 100);
  params.source.second_publisher_window_s = config.Number("second_publisher_window_s", {0.1, 60.0});
  params.source.restart_loop_restarts = config.Integer("restart_loop_restarts", 1, 100);
  params.source.restart_loop_window_s = config.Number("restart_loop_window_s", {1.0, 600.0});
  config.Finish();
  return params;
}

WatchdogNode::WatchdogNode(const WatchdogParams& params, Bus& bus, const Clock& clock)
    : bus_(bus),
      clock_(clock),
      watchdog_(params, WatchedChannels(), WatchedDaemons()),
      silence_(params.silence_s, params.status_period_s) {
  ForEachChannel([this](const auto& channel) {
    if (IsTruth(channel.name)) return;
    using Message = typename std::decay_t<decltype(channel)>::Message;
    if constexpr (std::is_same_v<Message, heartbeat_t>) {
      ListenToHeartbeats();
    } else {
      Listen(channel, WatchedChannelIndex(channel.name));
    }
  });
}

template <class M>
void WatchdogNode::Listen(const Channel<M>& channel, size_t source) {
  bus_.Subscribe(channel, [this, channel, source](const M& message) {
    const int64_t before = watchdog_.now();
    const auto status = watchdog_.Hear(source, {message.utime, message.boot_id, message.sequence});
    if (watchdog_.put_aside())
      bus_.Refuse(channel, "far ahead of all others; waits until the next message agrees");
    if (watchdog_.now() > before) silence_.Heard();
    if (status) Publish(*status);
  });
}

void WatchdogNode::ListenToHeartbeats() {
  bus_.Subscribe(channels::kHeartbeat, [this](const heartbeat_t& message) {
    const bool named = !message.daemon.empty() && message.daemon.size() <= kMaxNameLength;
    if (named &&
        watchdog_.HearHeartbeat(message.daemon, {message.utime, message.boot_id, message.sequence}))
      return;
    bus_.Refuse(channels::kHeartbeat, named ? "too many daemons" : "no name of a daemon");
  });
}

void WatchdogNode::Poll() {
  if (silence_.Poll(clock_.NowMicros())) Publish(watchdog_.Silent());
}

void WatchdogNode::Publish(const WatchdogStatus& status) {
  bus_.Publish(channels::kPipelineStatus, ToMessage(status));
}

}  // namespace hairpin
