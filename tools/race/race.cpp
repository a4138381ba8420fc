#include "tools/race/race.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "common/can/cannelloni_port.hpp"
#include "common/can/dbc.hpp"
#include "common/can/socketcan_port.hpp"
#include "tools/race/lockstep.hpp"
#include "tools/race/overrides.hpp"
#include "tools/race/progress.hpp"
#include "tools/race/recorder.hpp"

namespace hairpin {
namespace {

constexpr const char* kCanGateway = "can_gateway";
// In the race's own network namespace.
constexpr const char* kCarAddress = "127.0.0.1:20000";
constexpr const char* kGatewayAddress = "127.0.0.1:20001";
constexpr double kSimulatedBusSilence = 1.0;  // s
constexpr int kBufferForCones = 200;          // kB: what every kernel gives
constexpr double kStartPatience = 15.0;  // s of wall time until every daemon must have been heard

/// Waits until simulated time may go on: never faster than `speed` times real time.
class Pacer {
 public:
  /// `meanwhile` is called each 10 ms.
  void Wait(double simulated_s, double speed, const std::function<void()>& meanwhile) {
    const int64_t now = clock_.NowMicros();
    due_ = std::max(due_, now - kMaxLag);
    if (speed <= 0.0) {
      due_ = now;
      return;
    }
    due_ += static_cast<int64_t>(simulated_s / speed * 1e6);
    for (int64_t left = due_ - now; left > 0; left = due_ - clock_.NowMicros()) {
      std::this_thread::sleep_for(std::chrono::microseconds(std::min(left, kNap)));
      meanwhile();
    }
  }

 private:
  static constexpr int64_t kNap = 10'000;      // us
  static constexpr int64_t kMaxLag = 100'000;  // us: what is lost beyond this is not caught up
  MonotonicClock clock_;
  int64_t due_ = 0;
};

/// Switches sources and daemons off and on, by the time since Go.
class FaultInjector {
 public:
  FaultInjector(const std::vector<Fault>& faults, std::vector<std::string> daemons,
                Transport& transport)
      : faults_(faults), daemons_(std::move(daemons)), bus_(transport, "fault", 1) {
    bus_.Subscribe(channels::kAsState, [this](const as_state_t& message) {
      if (message.state == as_state_t::STATE_DRIVING && !go_utime_) go_utime_ = message.utime;
    });
  }

  void Apply(int64_t utime, Simulator& simulator, LidarRig* lidars, Stack& stack) {
    if (!go_utime_) return;
    const double since_go = SecondsBetween(*go_utime_, utime);
    std::map<std::string, bool> off;
    for (const Fault& fault : faults_)
      off[fault.source] = off[fault.source] || fault.ActiveAt(since_go);
    for (const auto& [source, is_off] : off) {
      if (is_off == off_[source]) continue;
      off_[source] = is_off;
      if (Contains(daemons_, source)) {
        stack.SetDaemon(source, !is_off);
      } else if (lidars != nullptr && Contains(LidarRig::Sources(), source)) {
        lidars->SetSource(source, !is_off);
      } else {
        simulator.SetSource(source, !is_off);
      }
    }
  }

 private:
  static bool Contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  }

  const std::vector<Fault>& faults_;
  std::vector<std::string> daemons_;
  Bus bus_;
  std::optional<int64_t> go_utime_;
  std::map<std::string, bool> off_;
};

void AwaitDaemons(const std::vector<std::string>& daemons, Transport& transport, Stack& stack,
                  const volatile int& stop) {
  std::set<std::string> missing(daemons.begin(), daemons.end());
  Bus bus(transport, "roll_call", 1);
  bus.Subscribe(channels::kHeartbeat,
                [&missing](const heartbeat_t& message) { missing.erase(message.daemon); });
  const MonotonicClock clock;
  const int64_t start = clock.NowMicros();
  while (!missing.empty() && stop == 0) {
    transport.Handle(20);
    stack.Tend(0);
    if (SecondsBetween(start, clock.NowMicros()) > kStartPatience) {
      std::string names;
      for (const std::string& name : missing) names += " " + name;
      throw std::runtime_error("not heard within 15 s:" + names);
    }
  }
}

/// The car's end of the CAN bus; the gateway has the other.
std::unique_ptr<CanPort> OpenCarPort(const RaceOptions& options, MemoryCanBus& memory,
                                     const Clock& clock) {
  if (options.can.empty()) return nullptr;
  if (options.in_process) return memory.Attach(clock);
  if (options.can != kCannelloni)
    return std::make_unique<SocketCanPort>(options.can, IdsOfTheComputer(), clock);
  return std::make_unique<CannelloniPort>(ParseUdpAddress(kCarAddress),
                                          ParseUdpAddress(kGatewayAddress), clock);
}

// What is to be checked of this computer before the car may be Ready: room where this run's log
// goes, and buffers for messages as large as there are.
std::vector<std::string> OverridesForHost(const RaceOptions& options) {
  const std::string folder = std::filesystem::path(options.log_file).parent_path().string();
  std::vector<std::string> overrides{"mission_manager.log_folder=" +
                                     (folder.empty() ? "." : folder)};
  if (options.stack.level == SensorLevel::kCones)
    overrides.push_back("mission_manager.min_receive_buffer_kb=" + std::to_string(kBufferForCones));
  return overrides;
}

StackOptions StackWith(const RaceOptions& options, const SimulatorParams& simulator,
                       MemoryCanBus& memory) {
  StackOptions stack = options.stack;
  // First, so that others may say otherwise.
  const std::vector<std::string> host = OverridesForHost(options);
  stack.overrides.insert(stack.overrides.begin(), host.begin(), host.end());
  const auto set = [&stack](const std::string& daemon, const std::string& key, const auto& value) {
    std::ostringstream text;
    text << daemon << '.' << key << '=' << std::setprecision(12) << value;
    stack.overrides.push_back(text.str());
  };
  if (!options.can.empty()) {
    if (stack.level == SensorLevel::kCones) stack.drivers.push_back(kCanGateway);
    stack.can_bus = &memory;
    set(kCanGateway, "interface", options.can);
    set(kCanGateway, "cannelloni_local", kGatewayAddress);
    set(kCanGateway, "cannelloni_remote", kCarAddress);
    // A simulated bus is silent while its computer is busy; the car's never is.
    if (!options.in_process) set(kCanGateway, "deadman.bus_silence_s", kSimulatedBusSilence);
  }
  if (stack.level == SensorLevel::kRaw) {
    // The track is surveyed: what the receiver measures is told in its frame.
    const GeodeticPoint origin = options.track.origin.value_or(simulator.gnss_receiver.origin);
    set("gnss_driver", "origin.is_first_fix", "false");
    set("gnss_driver", "origin.latitude_deg", origin.latitude_deg);
    set("gnss_driver", "origin.longitude_deg", origin.longitude_deg);
    set("gnss_driver", "origin.height_m", origin.height_m);
  }
  return stack;
}

bool IsPipeline(const std::string& source) {
  return source == "fusion" || source == "lidar" || source == "camera";
}

/// The LiDARs, plugged into the stack.
std::unique_ptr<LidarRig> MakeLidars(const LidarRigParams& params, const Car& car,
                                     const RaceOptions& options, Simulator& simulator,
                                     Stack& stack) {
  auto lidars = std::make_unique<LidarRig>(
      params, car, options.track, options.seed, Simulator::kFirstUtime,
      [&](const std::string& sensor, LidarRig::Port port, std::span<const uint8_t> packet) {
        stack.SendPacket(sensor, port == LidarRig::Port::kPosition, packet, simulator.utime());
      });
  simulator.OnMoved([rig = lidars.get(), &simulator] {
    rig->Advance(simulator.utime(), simulator.vehicle(), simulator.standing_cones());
  });
  return lidars;
}

/// Receiver and LiDARs speak to the stack, as the CAN port does already: the simulator itself
/// publishes nothing but the truth from then on.
std::unique_ptr<LidarRig> PlugInRawSensors(const SimulatorParams& params, const Car& car,
                                           const RaceOptions& options, Simulator& simulator,
                                           Stack& stack) {
  for (const std::string& source : Simulator::Sources()) {
    if (IsPipeline(source)) simulator.SetSource(source, false);
  }
  auto recording = std::make_shared<std::ofstream>();
  if (!options.receiver_file.empty()) {
    recording->open(options.receiver_file, std::ios::binary);
    if (!*recording) throw std::runtime_error(options.receiver_file + ": cannot be written");
  }
  simulator.OnGnss([&stack, recording](std::span<const uint8_t> bytes) {
    recording->write(reinterpret_cast<const char*>(bytes.data()),
                     static_cast<std::streamsize>(bytes.size()));
    stack.SendGnss(bytes);
  });
  return MakeLidars(params.lidars, car, options, simulator, stack);
}

struct SimulatorConfig {
  Car car;
  SimulatorParams params;
};

SimulatorConfig LoadSimulator(const StackOptions& options) {
  const Config config =
      Config::Load(options.config_dir, "simulator", OverridesOf("simulator", options.overrides));
  const Car car = LoadCar(config);
  return {car, LoadSimulatorParams(config)};
}

}  // namespace

std::vector<std::string> FaultSources(SensorLevel level, bool can) {
  std::vector<std::string> sources = Simulator::Sources();
  if (level == SensorLevel::kRaw) {
    std::erase_if(sources, IsPipeline);
    sources.insert(sources.end(), LidarRig::Sources().begin(), LidarRig::Sources().end());
  }
  const std::vector<std::string>& daemons = StackDaemons(level);
  sources.insert(sources.end(), daemons.begin(), daemons.end());
  if (can && level == SensorLevel::kCones) sources.push_back(kCanGateway);
  return sources;
}

RaceOutcome RunRace(const RaceOptions& asked, const volatile int& stop) {
  RaceOptions options = asked;
  if (options.stack.level == SensorLevel::kRaw && options.can.empty()) options.can = kCannelloni;
  const SimulatorConfig config = LoadSimulator(options.stack);
  Transport transport(options.in_process ? "memq://" : kDefaultLcmUrl);
  const SensorLevel level = options.stack.level;
  Recorder recorder(transport, options.log_file, options.log_scans);
  Progress progress(transport);
  const MonotonicClock clock;
  MemoryCanBus memory;
  const std::unique_ptr<CanPort> can = OpenCarPort(options, memory, clock);
  const StackOptions stack_options = StackWith(options, config.params, memory);
  const std::vector<std::string> daemons = DaemonsOf(stack_options);
  FaultInjector faults(options.faults, daemons, transport);
  std::optional<Lockstep> lockstep;
  std::unique_ptr<Stack> stack;
  if (options.in_process) {
    stack = std::make_unique<InProcessStack>(stack_options, transport);
  } else {
    if (options.attach) {
      stack = std::make_unique<AttachedStack>();
    } else {
      stack = std::make_unique<ProcessStack>(stack_options, transport.url());
    }
    AwaitDaemons(daemons, transport, *stack, stop);
    lockstep.emplace(transport, level, options.patience);
  }
  Bus bus(transport, "simulator", kSimulatorBootId);
  Simulator simulator(config.params, config.car, options.track, options.seed, bus, can.get());
  std::unique_ptr<LidarRig> lidars;
  if (level == SensorLevel::kRaw)
    lidars = PlugInRawSensors(config.params, config.car, options, simulator, *stack);
  const auto await_can = [&simulator] { return simulator.AwaitCan(); };

  const int64_t start_wall = clock.NowMicros();
  const int64_t start_utime = simulator.utime();
  Pacer pacer;
  bool was_ready = false;
  while (!simulator.done() && stop == 0) {
    faults.Apply(simulator.utime(), simulator, lidars.get(), *stack);
    const int64_t before = simulator.utime();
    recorder.SetTime(before);
    simulator.Step();
    if (lockstep) {
      lockstep->Await(before, await_can);
    } else {
      if (can) stack->Tend(simulator.utime());  // the gateway reads, and publishes
      transport.Drain();
    }
    stack->Tend(simulator.utime());
    progress.Show(simulator.utime());
    // Nobody waits for the checks before Ready: they take as long as they take.
    was_ready = was_ready || simulator.actuators().state() >= as_state_t::STATE_READY;
    double speed = was_ready ? options.speed : 0.0;
    const bool waiting = lockstep && lockstep->AnyoneSilent();
    if (waiting && (speed <= 0.0 || speed > 1.0)) speed = 1.0;
    pacer.Wait(SecondsBetween(before, simulator.utime()), speed, await_can);
  }
  transport.Drain();
  progress.End();
  const double wall = SecondsBetween(start_wall, clock.NowMicros());
  stack.reset();
  recorder.Close();
  return {simulator.result(), recorder.latencies_ms(),
          SecondsBetween(start_utime, simulator.utime()) / wall, lockstep ? lockstep->missed() : 0,
          stop != 0};
}

}  // namespace hairpin
