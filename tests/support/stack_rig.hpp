#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/race_run.hpp"
#include "tools/race/overrides.hpp"

namespace hairpin {

/// The simulated car and the whole stack in this process, tick by tick, for a test to meddle with.
class StackRig {
 public:
  explicit StackRig(const std::vector<std::string>& overrides = {})
      : config_(Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "simulator",
                             OverridesOf("simulator", overrides))),
        stack_(Options(overrides), transport_),
        simulator_(LoadSimulatorParams(config_), car_, LoadTrack(DefaultTrackFile()), 1, bus_) {
    bus_others_.Subscribe(channels::kAsState, [this](const as_state_t& message) {
      if (message.state != as_state.state) state_utime = message.utime;
      as_state = message;
    });
    bus_others_.Subscribe(channels::kPipelineStatus,
                          [this](const pipeline_status_t& message) { status = message; });
  }

  /// One tick of the car, and all that follows; `meddle` is called before.
  void Tick() {
    if (meddle) meddle();
    simulator_.Step();
    transport_.Drain();
    stack_.Tend(simulator_.utime());
    transport_.Drain();
  }
  void Run(double seconds) {
    for (double t = 0.0; t < seconds - 1e-9; t += Simulator::kTick) Tick();
  }
  /// Seconds until `done`; more than `patience` if it does not come to be.
  double RunUntil(const std::function<bool()>& done, double patience) {
    double t = 0.0;
    for (; t <= patience && !done(); t += Simulator::kTick) Tick();
    return t;
  }
  bool Is(int32_t state) const { return as_state.state == state; }
  double speed() const { return simulator_.vehicle().velocity.vx; }

  InProcessStack& stack() { return stack_; }
  Simulator& simulator() { return simulator_; }
  /// Of somebody who is not one of the stack.
  template <class M>
  void Publish(const Channel<M>& channel, const M& message) {
    bus_others_.Publish(channel, message);
  }

  std::function<void()> meddle;
  as_state_t as_state{};
  int64_t state_utime = 0;  // when the state was entered
  pipeline_status_t status{};

 private:
  static StackOptions Options(const std::vector<std::string>& overrides) {
    StackOptions options;
    options.config_dir = std::string(HAIRPIN_SOURCE_DIR) + "/config";
    options.overrides = {"mission_manager.log_folder=."};
    options.overrides.insert(options.overrides.end(), overrides.begin(), overrides.end());
    return options;
  }

  Config config_;
  Car car_ = LoadCar(config_);
  Transport transport_{"memq://"};
  Bus bus_{transport_, "simulator", 1'000'001};
  Bus bus_others_{transport_, "others", 1'000'002};
  InProcessStack stack_;
  Simulator simulator_;
};

}  // namespace hairpin
