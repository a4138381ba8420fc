#include "tools/race/race.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>

#include "tools/race/lockstep.hpp"
#include "tools/race/overrides.hpp"
#include "tools/race/progress.hpp"
#include "tools/race/recorder.hpp"

namespace hairpin {
namespace {

constexpr double kStartPatience = 15.0;  // s of wall time until every daemon must have been heard

/// Waits until simulated time may go on: never faster than `speed` times real time.
class Pacer {
 public:
  void Wait(double simulated_s, double speed) {
    const int64_t now = clock_.NowMicros();
    due_ = std::max(due_, now - kMaxLag);
    if (speed <= 0.0) {
      due_ = now;
      return;
    }
    due_ += static_cast<int64_t>(simulated_s / speed * 1e6);
    if (due_ > now) std::this_thread::sleep_for(std::chrono::microseconds(due_ - now));
  }

 private:
  static constexpr int64_t kMaxLag = 100'000;  // us: what is lost beyond this is not caught up
  MonotonicClock clock_;
  int64_t due_ = 0;
};

/// Switches sources and daemons off and on, by the time since Go.
class FaultInjector {
 public:
  FaultInjector(const std::vector<Fault>& faults, SensorLevel level, Transport& transport)
      : faults_(faults), level_(level), bus_(transport, "fault", 1) {
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
      if (Contains(StackDaemons(level_), source)) {
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
  SensorLevel level_;
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

bool IsPipeline(const std::string& source) {
  return source == "fusion" || source == "lidar" || source == "camera";
}

/// The LiDARs, plugged into the stack; the simulator's own pipelines say nothing then.
std::unique_ptr<LidarRig> MakeLidars(const LidarRigParams& params, const Car& car,
                                     const RaceOptions& options, Simulator& simulator,
                                     Stack& stack) {
  for (const std::string& source : Simulator::Sources()) {
    if (IsPipeline(source)) simulator.SetSource(source, false);
  }
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

std::vector<std::string> FaultSources(SensorLevel level) {
  std::vector<std::string> sources = Simulator::Sources();
  if (level == SensorLevel::kRaw) {
    std::erase_if(sources, IsPipeline);
    sources.insert(sources.end(), LidarRig::Sources().begin(), LidarRig::Sources().end());
  }
  const std::vector<std::string>& daemons = StackDaemons(level);
  sources.insert(sources.end(), daemons.begin(), daemons.end());
  return sources;
}

RaceOutcome RunRace(const RaceOptions& options, const volatile int& stop) {
  const SimulatorConfig config = LoadSimulator(options.stack);
  Transport transport(options.in_process ? "memq://" : kDefaultLcmUrl);
  const SensorLevel level = options.stack.level;
  Recorder recorder(transport, options.log_file, options.log_scans);
  Progress progress(transport);
  FaultInjector faults(options.faults, level, transport);
  std::optional<Lockstep> lockstep;
  std::unique_ptr<Stack> stack;
  if (options.in_process) {
    stack = std::make_unique<InProcessStack>(options.stack, transport);
  } else {
    if (options.attach) {
      stack = std::make_unique<AttachedStack>();
    } else {
      stack = std::make_unique<ProcessStack>(options.stack, transport.url());
    }
    AwaitDaemons(StackDaemons(level), transport, *stack, stop);
    lockstep.emplace(transport, level);
  }
  Bus bus(transport, "simulator", 1);
  Simulator simulator(config.params, config.car, options.track, options.seed, bus);
  std::unique_ptr<LidarRig> lidars;
  if (level == SensorLevel::kRaw)
    lidars = MakeLidars(config.params.lidars, config.car, options, simulator, *stack);

  const MonotonicClock clock;
  const int64_t start_wall = clock.NowMicros();
  const int64_t start_utime = simulator.utime();
  Pacer pacer;
  while (!simulator.done() && stop == 0) {
    faults.Apply(simulator.utime(), simulator, lidars.get(), *stack);
    const int64_t before = simulator.utime();
    recorder.SetTime(before);
    simulator.Step();
    if (lockstep) {
      lockstep->Await(before);
    } else {
      transport.Drain();
    }
    stack->Tend(simulator.utime());
    progress.Show(simulator.utime());
    const bool waiting = lockstep && lockstep->AnyoneSilent();
    const double speed =
        waiting && (options.speed <= 0.0 || options.speed > 1.0) ? 1.0 : options.speed;
    pacer.Wait(SecondsBetween(before, simulator.utime()), speed);
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
