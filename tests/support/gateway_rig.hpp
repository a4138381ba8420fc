#pragma once

#include <string>

#include "common/config.hpp"
#include "daemons/can_gateway/can_gateway.hpp"
#include "daemons/can_gateway/can_gateway_node.hpp"
#include "hairpin/as_state_t.hpp"
#include "tests/support/test_car.hpp"

namespace hairpin {

inline CanGatewayParams ShippedCanGatewayParams() {
  return LoadCanGatewayConfig(
             Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "can_gateway"))
      .gateway;
}

/// A gateway between a car and those who supervise it, all in ticks of 10 ms.
class GatewayRig : public TestCar {
 public:
  static constexpr int64_t kStart = 1'700'000'000'000'000;
  static constexpr int64_t kTick = 10'000;

  GatewayRig() : gateway(ShippedCanGatewayParams()) {}

  /// One tick: frames of the car, and of those who supervise.
  void Tick() {
    ++ticks_;
    if (car_time_runs) now += kTick;
    wall += kTick;
    if (car_talks) {
      for (const CanFrame& frame : Frames(now, ticks_)) Send(frame);
    }
    if (watchdog_lives) gateway.OnSupervisor({now, stop_asked, emergency_asked}, wall);
    if (mission_manager_lives && (ticks_ % 5 == 0 || state != said_state_)) SayState();
    if (commands_flow) refusal = gateway.OnCommand({now, moves, command, 5.0}, wall);
    Listen();
    for (const CanFrame& frame : gateway.Due(wall)) Hear(frame);
  }
  void Run(int ticks) {
    for (int i = 0; i < ticks; ++i) Tick();
  }
  /// Ready for a second, then Driving.
  void Drive() {
    state = as_state_t::STATE_READY;
    moves = false;
    Run(100);
    state = as_state_t::STATE_DRIVING;
    moves = true;
    Run(30);
  }
  /// Ticks until `done`, at most 100; -1 if it does not come to be.
  template <class Done>
  int TicksUntil(Done done) {
    for (int i = 0; i <= 100; ++i) {
      if (done()) return i;
      Tick();
    }
    return -1;
  }
  void Send(const CanFrame& frame) { gateway.OnFrame({frame, wall}); }
  int64_t Refused(const std::string& what) const {
    const auto found = gateway.decoder().refusals().find(what);
    return found == gateway.decoder().refusals().end() ? 0 : found->second;
  }

  CanGateway gateway;
  int64_t now = kStart;
  int64_t wall = 5'000'000;
  bool car_talks = true;
  bool car_time_runs = true;
  bool watchdog_lives = true;
  bool mission_manager_lives = true;
  bool commands_flow = true;
  bool stop_asked = false;
  bool emergency_asked = false;
  int state = as_state_t::STATE_OFF;
  bool moves = false;
  DriveOrder command{0.1, {20.0, 20.0, 20.0, 20.0}, 0.0};
  std::string refusal;

 private:
  void SayState() {
    said_state_ = state;
    gateway.OnAsReport({now, state, 6, 2, false}, wall);
  }

  int ticks_ = -1;
  int said_state_ = -1;
};

}  // namespace hairpin
