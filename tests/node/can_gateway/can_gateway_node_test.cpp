#include "daemons/can_gateway/can_gateway_node.hpp"

#include <gtest/gtest.h>

#include "common/can/memory_can_bus.hpp"
#include "tests/support/gateway_rig.hpp"

namespace hairpin {
namespace {

constexpr int64_t kStart = 1'700'000'000'000'000;
constexpr int64_t kTick = 10'000;

/// The node between a car on a CAN bus and a stack on memq.
class GatewayOnABus : public testing::Test {
 protected:
  GatewayOnABus() {
    clock_.Set(1'000'000);
    auto port = can_.Attach(clock_);
    port_ = port.get();
    node_.emplace(ShippedCanGatewayParams(), bus_, std::move(port), clock_);
    stack_.Subscribe(channels::kImu, [this](const imu_t& m) { imus_.push_back(m); });
    stack_.Subscribe(channels::kMotors, [this](const motors_t& m) { motors_.push_back(m); });
    stack_.Subscribe(channels::kSteering, [this](const steering_t&) { ++steerings_; });
    stack_.Subscribe(channels::kGroundSpeed, [this](const ground_speed_t&) { ++ground_speeds_; });
    stack_.Subscribe(channels::kVehicle, [this](const vehicle_t& m) { vehicles_.push_back(m); });
  }
  void Tick() {
    now_ += kTick;
    clock_.Set(clock_.NowMicros() + kTick);
    car_port_->Send(car_.Frames(now_, ++ticks_));
    node_->Poll();
    pipeline_status_t status{};
    status.utime = now_;
    stack_.Publish(channels::kPipelineStatus, status);
    as_state_t state{};
    state.utime = now_;
    state.state = state_;
    stack_.Publish(channels::kAsState, state);
    drive_command_t command{};
    command.utime = now_;
    command.action = action_;
    for (double& torque : command.wheel_torque_nm) torque = 20.0;
    stack_.Publish(channels::kDriveCommand, command);
    transport_.Drain();
    car_.Listen();
    while (const auto frame = car_port_->Receive()) car_.Hear(frame->frame);
  }
  void Run(int ticks) {
    for (int i = 0; i < ticks; ++i) Tick();
  }
  int64_t RefusedCommands() const {
    for (const channel_health_t& health : bus_.Health()) {
      if (health.channel == channels::kDriveCommand.name) return health.refused;
    }
    return -1;
  }

  ManualClock clock_;
  MemoryCanBus can_;
  Transport transport_{"memq://"};
  Bus bus_{transport_, "can_gateway", 1};
  Bus stack_{transport_, "stack", 2};
  std::unique_ptr<MemoryCanBus::Port> car_port_ = can_.Attach(clock_);
  MemoryCanBus::Port* port_ = nullptr;
  std::optional<CanGatewayNode> node_;
  TestCar car_;
  int64_t now_ = kStart;
  int ticks_ = -1;
  int state_ = as_state_t::STATE_READY;
  int32_t action_ = drive_command_t::ACTION_HOLD;
  std::vector<imu_t> imus_;
  std::vector<motors_t> motors_;
  std::vector<vehicle_t> vehicles_;
  int steerings_ = 0;
  int ground_speeds_ = 0;
};

TEST_F(GatewayOnABus, PublishesWhatTheFramesSayAtTheTimeOfTheMeasurement) {
  Run(10);
  ASSERT_EQ(imus_.size(), 10u);
  ASSERT_EQ(motors_.size(), 10u);
  ASSERT_EQ(vehicles_.size(), 2u);
  EXPECT_EQ(steerings_, 10);
  EXPECT_EQ(ground_speeds_, 10);
  EXPECT_EQ(imus_.back().utime, now_);
  EXPECT_NEAR(imus_.back().acceleration_mps2[0], 1.0, 1e-9);
  EXPECT_NEAR(imus_.back().angular_rate_radps[2], 0.3, 1e-9);
  EXPECT_NEAR(motors_.back().wheel_speed_radps[3], 20.0, 1e-9);
  const vehicle_t& vehicle = vehicles_.back();
  EXPECT_EQ(vehicle.mission, vehicle_t::MISSION_AUTOCROSS);
  EXPECT_TRUE(vehicle.master_switch_on && vehicle.tractive_system_on);
  EXPECT_TRUE(vehicle.shutdown_circuit_closed && vehicle.brakes_ok && vehicle.res_go);
  EXPECT_EQ(vehicle.ebs_state, vehicle_t::EBS_ARMED);
  EXPECT_FALSE(vehicle.res_stop);
  EXPECT_NEAR(vehicle.speed_mps, 20.0 * 0.231, 1e-9);
}

TEST_F(GatewayOnABus, CountsCommandsThatAreRefusedWhereTheHeartbeatShowsIt) {
  action_ = drive_command_t::ACTION_DRIVE;
  Run(10);
  EXPECT_EQ(RefusedCommands(), 10);
  EXPECT_EQ(car_.front.left_nm, 0.0);
}

TEST_F(GatewayOnABus, PassesCommandsOnceAsIsDriving) {
  Run(10);
  state_ = as_state_t::STATE_DRIVING;
  action_ = drive_command_t::ACTION_DRIVE;
  Run(10);
  EXPECT_EQ(RefusedCommands(), 0);
  EXPECT_NEAR(car_.front.left_nm, 20.0, 0.02);
  EXPECT_TRUE(car_.heartbeat);
}

TEST_F(GatewayOnABus, LeavesTheActuatorsNeutralWhenItEnds) {
  Run(10);
  state_ = as_state_t::STATE_DRIVING;
  action_ = drive_command_t::ACTION_DRIVE;
  Run(10);
  node_.reset();
  car_.Listen();
  while (const auto frame = car_port_->Receive()) car_.Hear(frame->frame);
  EXPECT_EQ(car_.frames, 4);
  EXPECT_FALSE(car_.heartbeat || car_.front.enable || car_.steering.enable);
  EXPECT_EQ(car_.front.left_nm, 0.0);
  EXPECT_EQ(car_.brake.level_percent, 50.0);
}

}  // namespace
}  // namespace hairpin
