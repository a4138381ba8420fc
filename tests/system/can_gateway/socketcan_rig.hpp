#pragma once

#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "common/can/socketcan_port.hpp"
#include "daemons/can_gateway/can_gateway_node.hpp"
#include "hairpin/as_state_t.hpp"
#include "tests/support/gateway_rig.hpp"
#include "tests/support/test_car.hpp"

namespace hairpin {

inline constexpr int64_t kStart = 1'700'000'000'000'000;
inline constexpr int64_t kTick = 10'000;

/// A bare socket, for what no port of ours would send.
class RawSocket {
 public:
  explicit RawSocket(const char* interface) : socket_(socket(PF_CAN, SOCK_RAW, CAN_RAW)) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex(interface));
    if (bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("no CAN");
  }
  ~RawSocket() { close(socket_); }
  void Send(uint32_t id, uint8_t length = 8) const {
    can_frame frame{};
    frame.can_id = id;
    frame.len = length;
    while (write(socket_, &frame, sizeof frame) != sizeof frame) usleep(100);
  }

 private:
  int socket_;
};

/// The gateway on its port, and a car on the other end. Its clocks stand still but for 10 ms a
/// tick, so that a slow machine sees the same.
class SocketCan : public testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("HAIRPIN_IN_UML") == nullptr) GTEST_SKIP() << "runs in user-mode-linux only";
    clock_.Set(1'000'000);
    Open("vcan0", "vcan0");
  }
  void Open(const char* gateway_interface, const char* car_interface) {
    port_ = std::make_unique<SocketCanPort>(gateway_interface, IdsOfTheCar(), clock_);
    car_port_ = std::make_unique<SocketCanPort>(car_interface, IdsOfTheComputer(), clock_);
  }
  void Tick() {
    ++ticks_;
    now_ += kTick;
    clock_.Set(clock_.NowMicros() + kTick);
    if (car_talks_) {
      const std::vector<CanFrame> frames = car_.Frames(now_, ticks_);
      car_port_->Send(frames);
      sent_ += static_cast<int64_t>(frames.size());
    }
    while (const auto frame = port_->Receive()) {
      const auto state = state_heard_.find(frame->frame.id);
      if (state != state_heard_.end()) state->second = ticks_;
      Count(gateway_.OnFrame(*frame));
    }
    for (const auto& [id, heard] : state_heard_)
      longest_silence_ = std::max(longest_silence_, (ticks_ - heard) * kTick);
    if (stack_talks_) Answer();
    gateway_.OnBus(port_->state());
    port_->Send(gateway_.Due(clock_.NowMicros()));
    car_.Listen();
    while (const auto frame = car_port_->Receive()) {
      if (frame->frame.id == dbc::TorqueCommandFront::kId) torques_.push_back(frame->frame);
      car_.Hear(frame->frame, strict_);
    }
  }
  void Run(int ticks) {
    for (int i = 0; i < ticks; ++i) Tick();
  }
  void Drive() {
    state_ = as_state_t::STATE_READY;
    Run(30);
    state_ = as_state_t::STATE_DRIVING;
    Run(30);
    ASSERT_NEAR(car_.front.left_nm, 20.0, 0.02);
    ASSERT_TRUE(car_.heartbeat);
  }
  void Drain() {
    while (port_->Receive()) {
    }
  }
  const std::string& Emergency() const { return gateway_.supervision().emergency(); }

  ManualClock clock_;
  CanGateway gateway_{ShippedCanGatewayParams()};
  std::unique_ptr<SocketCanPort> port_;
  std::unique_ptr<SocketCanPort> car_port_;
  TestCar car_;
  bool car_talks_ = true;
  bool stack_talks_ = true;
  bool strict_ = true;
  int state_ = as_state_t::STATE_OFF;
  int64_t now_ = kStart;
  int64_t sent_ = 0;
  int ticks_ = -1;
  // Tick at which each state of the car was last heard, and the longest that one was not [us].
  std::map<uint32_t, int> state_heard_{
      {dbc::VehicleStatus::kId, -1}, {dbc::ResStatus::kId, -1}, {dbc::Brakes::kId, -1}};
  int64_t longest_silence_ = 0;
  std::vector<CanFrame> torques_;  // all that came out
  int64_t imus_ = 0;
  int64_t motors_ = 0;
  int64_t vehicles_ = 0;

 private:
  void Count(const std::optional<Measurement>& measurement) {
    if (!measurement) return;
    if (std::holds_alternative<ImuSample>(*measurement)) ++imus_;
    if (std::holds_alternative<MotorsSample>(*measurement)) ++motors_;
    if (std::holds_alternative<VehicleSample>(*measurement)) ++vehicles_;
  }
  void Answer() {
    const int64_t wall = clock_.NowMicros();
    const bool drives = state_ == as_state_t::STATE_DRIVING;
    gateway_.OnSupervisor({now_, false, false}, wall);
    gateway_.OnAsReport({now_, state_, 6, 0, false}, wall);
    gateway_.OnCommand({now_, drives, {0.1, {20.0, 20.0, 20.0, 20.0}, 0.0}, 5.0}, wall);
  }
};

}  // namespace hairpin
