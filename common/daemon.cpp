#include "common/daemon.hpp"

#include <poll.h>
#include <systemd/sd-daemon.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <random>

#include "common/clock.hpp"
#include "common/program.hpp"

namespace hairpin {
namespace {

constexpr double kHeartbeatPeriod = 0.1;  // s
constexpr int kPollPeriodMs = 10;         // for nodes with work of their own
constexpr int kIdlePeriodMs = 100;

volatile std::sig_atomic_t stop_requested = 0;

void RequestStop(int) { stop_requested = 1; }

void CatchSignals() {
  struct sigaction action {};
  action.sa_handler = RequestStop;  // without SA_RESTART: a waiting receive returns
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int64_t RandomBootId() {
  std::random_device random;
  return static_cast<int64_t>((uint64_t{random()} << 32 | random()) >> 1);
}

struct Options {
  std::string config_dir = "config";
  std::string lcm_url = kDefaultLcmUrl;
  std::vector<std::string> overrides;
  std::string instance;
};

void DefineOptions(CLI::App& app, const DaemonSpec& spec, Options& options) {
  AddConfigDirOption(app, options.config_dir);
  app.add_option("--lcm-url", options.lcm_url, "LCM provider")
      ->capture_default_str()
      ->envname("LCM_DEFAULT_URL");
  app.add_option("--set", options.overrides,
                 "KEY=VALUE in place of the config file's value (repeatable)")
      ->allow_extra_args(false);
  if (!spec.instances.empty()) {
    app.add_option("--instance", options.instance, "which of the car's")
        ->required()
        ->check(CLI::IsMember(spec.instances));
  }
  for (const DaemonOption& option : spec.options)
    app.add_option(option.name, *option.value, option.help);
  app.set_version_flag("--version", BuildId());
}

std::string NameOnBus(const DaemonSpec& spec, const Options& options) {
  return options.instance.empty() ? spec.name : spec.name + "_" + options.instance;
}

// Waits for a message, which it handles, or for one of the node's descriptors.
void Wait(Transport& transport, const HostedNode& node) {
  const int timeout_ms = node.has_poll() ? kPollPeriodMs : kIdlePeriodMs;
  const std::vector<int> descriptors = node.descriptors();
  if (descriptors.empty()) {
    transport.Handle(timeout_ms);
    return;
  }
  std::vector<pollfd> waiting{{transport.descriptor(), POLLIN, 0}};
  for (const int descriptor : descriptors) waiting.push_back({descriptor, POLLIN, 0});
  if (poll(waiting.data(), waiting.size(), timeout_ms) < 0 && errno != EINTR)
    throw std::runtime_error(std::string("poll failed: ") + std::strerror(errno));
  if (waiting.front().revents != 0) transport.Handle(0);
}

void Work(const DaemonSpec& spec, const Options& options, const NodeFactory& factory) {
  const Config config = Config::Load(options.config_dir, spec.name, options.overrides);
  Transport transport(options.lcm_url);
  Bus bus(transport, NameOnBus(spec, options), RandomBootId());
  Heartbeat heartbeat(bus, config.SiblingHash("car"));
  const std::unique_ptr<HostedNode> node = factory(bus, config);
  sd_notify(0, "READY=1");
  const MonotonicClock clock;
  int64_t last_beat = clock.NowMicros();
  int64_t last_utime = 0;
  while (stop_requested == 0) {
    Wait(transport, *node);
    node->Poll();
    sd_notify(0, "WATCHDOG=1");
    // Heartbeats follow data time. Where that stands still, even if others' heartbeats are heard,
    // they follow the wall.
    const int64_t now = clock.NowMicros();
    const bool stands_still = bus.newest_utime() == last_utime;
    if (stands_still && SecondsBetween(last_beat, now) < kHeartbeatPeriod) continue;
    if (stands_still) heartbeat.Send();
    last_utime = bus.newest_utime();
    last_beat = now;
  }
  sd_notify(0, "STOPPING=1");
}

}  // namespace

Heartbeat::Heartbeat(Bus& bus, int64_t car_hash) : bus_(bus), car_hash_(car_hash) {
  bus_.OnDataTime([this](int64_t utime) { OnDataTime(utime); });
}

void Heartbeat::OnDataTime(int64_t utime) {
  if (SecondsBetween(last_sent_utime_, utime) < kHeartbeatPeriod) return;
  last_sent_utime_ = utime;
  Send();
}

void Heartbeat::Send() {
  heartbeat_t message{};
  message.utime = bus_.newest_utime();
  message.daemon = bus_.daemon();
  message.build = BuildId();
  message.types_hash = TypesHash();
  message.car_hash = car_hash_;
  message.channels = bus_.Health();
  message.num_channels = static_cast<int32_t>(message.channels.size());
  bus_.Publish(channels::kHeartbeat, message);
}

int RunHosted(const DaemonSpec& spec, int argc, char** argv, const NodeFactory& factory) {
  CLI::App app("hairpin " + spec.name + ": see daemons/" + spec.name + "/README.md", spec.name);
  Options options;
  DefineOptions(app, spec, options);
  return RunProgram(app, argc, argv, [&] {
    app.name(NameOnBus(spec, options));
    CatchSignals();
    Work(spec, options, factory);
    return 0;
  });
}

}  // namespace hairpin
