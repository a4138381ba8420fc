// The gateway against the kernel's own CAN, in user-mode-linux: the machine that tests need not
// have any. One boot runs all tests named DISABLED_SocketCan; the gateway is the node itself, on
// its port; the car sits on the other end of vcan0.
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>

#include "common/can/socketcan_port.hpp"
#include "daemons/can_gateway/can_gateway_node.hpp"
#include "hairpin/as_state_t.hpp"
#include "tests/support/gateway_rig.hpp"
#include "tests/support/process.hpp"
#include "tests/support/test_car.hpp"

namespace hairpin {
namespace {

constexpr int kBootPatienceMs = 180'000;
constexpr int64_t kStart = 1'700'000'000'000'000;
constexpr int64_t kTick = 10'000;

std::string InitScript(const std::string& test) {
  return R"(#!/bin/sh
export PATH=/usr/sbin:/usr/bin:/sbin:/bin HAIRPIN_IN_UML=1 TMPDIR=/run
mount -t proc none /proc; mount -t sysfs none /sys; mount -t tmpfs none /run
modules=/usr/lib/uml/modules/$(uname -r)/kernel
for m in net/can/can net/can/can-raw drivers/net/can/dev/can-dev drivers/net/can/vcan drivers/net/can/vxcan net/sched/sch_netem; do
  insmod $modules/$m.ko || echo "no module $m"
done
ip link set lo up; ip route add 224.0.0.0/4 dev lo
ip link add vcan0 type vcan; ip link set vcan0 up
ip link add vxcan0 type vxcan peer name vxcan1; ip link set vxcan0 up; ip link set vxcan1 up
tc qdisc add dev vxcan1 root netem loss 5%
')" + test +
         R"(' --gtest_also_run_disabled_tests '--gtest_filter=DISABLED_SocketCan*' --gtest_color=no
echo "tests ended with $?"
echo o > /proc/sysrq-trigger
sleep 10
)";
}

TEST(UserModeLinux, PassesEveryTestOfTheGatewayOnTheKernelsCan) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "sanitizers do not run in user-mode-linux";
#endif
  if (!std::filesystem::exists("/usr/bin/linux.uml")) GTEST_SKIP() << "no user-mode-linux here";
  const std::string folder = testing::TempDir() + "hairpin_uml_" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  const std::string init = folder + "/init";
  std::ofstream(init) << InitScript(std::filesystem::read_symlink("/proc/self/exe"));
  chmod(init.c_str(), 0755);
  Process kernel({"sh", "-c",
                  "exec linux.uml mem=256M root=/dev/root rootfstype=hostfs rootflags=/ ro quiet "
                  "con=null con0=null,fd:2 con1=fd:0,fd:1 init=\"$0\" </dev/null",
                  init});
  const std::optional<int> code = kernel.Wait(kBootPatienceMs);
  std::filesystem::remove_all(folder);
  ASSERT_TRUE(code) << "still running";
  const std::string output = kernel.Output();
  if (output.find("[==========]") == std::string::npos)
    GTEST_SKIP() << "user-mode-linux does not run here: " << output;
  EXPECT_NE(output.find("tests ended with 0"), std::string::npos) << output;
  EXPECT_EQ(output.find("[  SKIPPED ]"), std::string::npos) << output;
}

std::vector<uint32_t> IdsOfTheComputer() {
  std::vector<uint32_t> ids;
  dbc::ForEachMessage([&ids]<class M>(const M&) {
    if (M::kFromComputer) ids.push_back(M::kId);
  });
  return ids;
}

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

/// Gateway and car on one bus, in real time; the stack's answers by memq.
class SocketCan : public testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("HAIRPIN_IN_UML") == nullptr) GTEST_SKIP() << "runs in user-mode-linux only";
    Open("vcan0", "vcan0");
  }
  void Open(const char* gateway_interface, const char* car_interface) {
    node_.reset();
    gateway_port_ = new SocketCanPort(gateway_interface, IdsOfTheCar(), clock_);
    node_ = std::make_unique<CanGatewayNode>(ShippedCanGatewayParams(), bus_,
                                             std::unique_ptr<CanPort>(gateway_port_), clock_);
    car_port_ = std::make_unique<SocketCanPort>(car_interface, IdsOfTheComputer(), clock_);
  }
  /// One tick; `pace`: each takes 10 ms of wall time, as its car time says.
  void Tick(bool pace) {
    ++ticks_;
    now_ += kTick;
    if (car_talks_) {
      const std::vector<CanFrame> frames = car_.Frames(now_, ticks_);
      car_port_->Send(frames);
      sent_ += static_cast<int64_t>(frames.size());
    }
    node_->Poll();
    if (stack_talks_) Answer();
    transport_.Drain();
    car_.Listen();
    while (const auto frame = car_port_->Receive()) car_.Hear(frame->frame, strict_);
    if (pace) std::this_thread::sleep_for(std::chrono::microseconds(kTick));
  }
  void Run(int ticks, bool pace = false) {
    for (int i = 0; i < ticks; ++i) Tick(pace);
  }
  void Drive() {
    state_ = as_state_t::STATE_READY;
    Run(30);
    state_ = as_state_t::STATE_DRIVING;
    Run(30);
    ASSERT_NEAR(car_.front.left_nm, 20.0, 0.02);
    ASSERT_TRUE(car_.heartbeat);
  }
  const std::string& Emergency() const { return node_->gateway().supervision().emergency(); }

  MonotonicClock clock_;
  Transport transport_{"memq://"};
  Bus bus_{transport_, "can_gateway", 1};
  Bus stack_{transport_, "stack", 2};
  SocketCanPort* gateway_port_ = nullptr;
  std::unique_ptr<CanGatewayNode> node_;
  std::unique_ptr<SocketCanPort> car_port_;
  TestCar car_;
  bool car_talks_ = true;
  bool stack_talks_ = true;
  bool strict_ = true;
  int state_ = as_state_t::STATE_OFF;
  int64_t now_ = kStart;
  int64_t sent_ = 0;
  int ticks_ = -1;

 private:
  void Answer() {
    pipeline_status_t status{};
    status.utime = now_;
    status.map_mode = pipeline_status_t::MODE_FUSION;
    stack_.Publish(channels::kPipelineStatus, status);
    as_state_t as{};
    as.utime = now_;
    as.state = state_;
    stack_.Publish(channels::kAsState, as);
    drive_command_t command{};
    command.utime = now_;
    const bool drives = state_ == as_state_t::STATE_DRIVING;
    command.action = drive_command_t::ACTION_HOLD;
    if (drives) command.action = drive_command_t::ACTION_DRIVE;
    if (drives) std::fill_n(command.wheel_torque_nm, 4, 20.0);
    stack_.Publish(channels::kDriveCommand, command);
  }
};

using DISABLED_SocketCan = SocketCan;

TEST_F(DISABLED_SocketCan, FiltersInTheKernelWhatIsNotOfTheCar) {
  Drive();
  const int64_t before = gateway_port_->counts().received;
  const RawSocket stranger("vcan0");
  for (uint32_t id = 0; id < 0x800; ++id) {
    const std::vector<uint32_t> ids = IdsOfTheCar();
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) stranger.Send(id);
  }
  for (const uint32_t id : IdsOfTheCar()) {
    stranger.Send(id | CAN_EFF_FLAG);
    stranger.Send(id | CAN_RTR_FLAG);
  }
  node_->Poll();
  EXPECT_EQ(gateway_port_->counts().received, before);
  stranger.Send(dbc::CarTime::kId, 3);
  node_->Poll();
  EXPECT_EQ(gateway_port_->counts().received, before + 1);
}

TEST_F(DISABLED_SocketCan, StampsFramesWhenTheKernelTookThem) {
  car_port_->Send(car_.Frames(now_, 1));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const auto frame = gateway_port_->Receive();
  ASSERT_TRUE(frame);
  EXPECT_GE(clock_.NowMicros() - frame->arrival_micros, 45'000);
}

TEST_F(DISABLED_SocketCan, LosesNoFrameOfALap) {
  state_ = as_state_t::STATE_READY;
  int64_t imus = 0;
  int64_t motors = 0;
  int64_t vehicles = 0;
  stack_.Subscribe(channels::kImu, [&](const imu_t&) { ++imus; });
  stack_.Subscribe(channels::kMotors, [&](const motors_t&) { ++motors; });
  stack_.Subscribe(channels::kVehicle, [&](const vehicle_t&) { ++vehicles; });
  Drive();
  constexpr int kLap = 4'000;  // 40 s
  Run(kLap);
  EXPECT_EQ(gateway_port_->counts().received, sent_);
  EXPECT_EQ(gateway_port_->counts().overflowed, 0);
  EXPECT_EQ(car_port_->counts().received, gateway_port_->counts().sent);
  EXPECT_EQ(gateway_port_->counts().unsent, 0);
  EXPECT_EQ(node_->gateway().decoder().refused(), 0);
  EXPECT_EQ(imus, kLap + 60);
  EXPECT_EQ(motors, kLap + 60);
  EXPECT_EQ(vehicles, (kLap + 60) / 5);
  EXPECT_EQ(Emergency(), "");
  std::cout << sent_ << " frames in, " << gateway_port_->counts().sent << " out\n";
}

TEST_F(DISABLED_SocketCan, KeepsTheCarDrivingInAFloodOf5000FramesASecond) {
  Drive();
  const int64_t before = gateway_port_->counts().received;
  const int64_t sent_before = sent_;
  std::atomic<bool> stop = false;
  int64_t flood = 0;
  const int64_t start = clock_.NowMicros();
  std::thread flooder([&] {
    const RawSocket stranger("vcan0");
    while (!stop) {
      for (int i = 0; i < 25; ++i, ++flood) stranger.Send(0x600);
      const int64_t due = start + flood * 200 - clock_.NowMicros();  // 5000 a second
      if (due > 0) std::this_thread::sleep_for(std::chrono::microseconds(due));
    }
  });
  rusage usage_before{};
  getrusage(RUSAGE_THREAD, &usage_before);
  while (clock_.NowMicros() - start < 2'000'000) Tick(true);
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  stop = true;
  flooder.join();
  const double seconds = static_cast<double>(clock_.NowMicros() - start) * 1e-6;
  const auto cpu_seconds = [](const rusage& r) {
    return static_cast<double>(r.ru_utime.tv_sec) + 1e-6 * static_cast<double>(r.ru_utime.tv_usec);
  };
  std::cout << flood << " foreign frames in " << seconds << " s; gateway and car took "
            << cpu_seconds(usage) - cpu_seconds(usage_before) << " s\n";
  EXPECT_GT(static_cast<double>(flood), 4'500.0 * seconds);
  EXPECT_EQ(gateway_port_->counts().received - before, sent_ - sent_before)
      << "the kernel keeps the flood out, and loses nothing";
  EXPECT_EQ(gateway_port_->counts().overflowed, 0);
  EXPECT_EQ(Emergency(), "");
  EXPECT_TRUE(car_.heartbeat);
}

TEST_F(DISABLED_SocketCan, CountsErrorFramesThatAreHarmless) {
  Drive();
  const RawSocket controller("vcan0");
  controller.Send(CAN_ERR_FLAG | CAN_ERR_CRTL);
  Run(2);
  EXPECT_EQ(gateway_port_->counts().error_frames, 1);
  EXPECT_EQ(gateway_port_->state(), CanState::kActive);
  EXPECT_EQ(Emergency(), "");
}

TEST_F(DISABLED_SocketCan, BusOffWhileDrivingEndsTheHeartbeatAndNothingOldComesOutAfterwards) {
  Drive();
  const RawSocket controller("vcan0");
  controller.Send(CAN_ERR_FLAG | CAN_ERR_BUSOFF | CAN_ERR_CRTL);
  const int64_t sent = gateway_port_->counts().sent;
  Run(20);
  EXPECT_EQ(gateway_port_->state(), CanState::kBusOff);
  EXPECT_EQ(gateway_port_->counts().bus_offs, 1);
  EXPECT_EQ(gateway_port_->counts().sent, sent) << "nothing is sent, nothing is kept";
  EXPECT_GT(gateway_port_->counts().unsent, 0);
  EXPECT_EQ(Emergency(), "CAN bus-off");
  controller.Send(CAN_ERR_FLAG | CAN_ERR_RESTARTED);
  strict_ = false;  // the counters have jumped
  Tick(false);
  Tick(false);
  EXPECT_EQ(gateway_port_->state(), CanState::kActive);
  EXPECT_GT(car_.frames, 0);
  EXPECT_EQ(car_.front.left_nm, 0.0) << "the first that comes out is neutral";
  EXPECT_FALSE(car_.front.enable);
  Run(20);
  EXPECT_FALSE(car_.heartbeat);
}

TEST_F(DISABLED_SocketCan, BusOffBeforeTheCarIsArmedRecovers) {
  Run(30);
  ASSERT_TRUE(car_.heartbeat);
  const RawSocket controller("vcan0");
  controller.Send(CAN_ERR_FLAG | CAN_ERR_BUSOFF);
  Run(10);
  EXPECT_FALSE(car_.heartbeat);
  controller.Send(CAN_ERR_FLAG | CAN_ERR_RESTARTED);
  strict_ = false;
  Run(10);
  EXPECT_TRUE(car_.heartbeat);
  EXPECT_EQ(Emergency(), "");
}

TEST_F(DISABLED_SocketCan, AnInterfaceThatGoesDownIsFoundAgain) {
  Run(30);
  ASSERT_EQ(std::system("ip link set vcan0 down"), 0);
  Run(10);
  EXPECT_EQ(gateway_port_->state(), CanState::kDown);
  EXPECT_FALSE(car_.heartbeat);
  ASSERT_EQ(std::system("ip link set vcan0 up"), 0);
  strict_ = false;
  Run(50, true);
  EXPECT_EQ(gateway_port_->state(), CanState::kActive);
  EXPECT_TRUE(car_.heartbeat);
}

TEST_F(DISABLED_SocketCan, DeadmanCountsCarTimeWhileFramesFlow) {
  Drive();
  stack_talks_ = false;
  Run(5);
  EXPECT_EQ(car_.status.deadman_stage, 0) << "50 ms";
  Run(1);
  EXPECT_EQ(car_.status.deadman_stage, 1) << "60 ms";
  Run(4);
  EXPECT_NEAR(car_.front.left_nm, 20.0, 0.02) << "100 ms";
  Run(1);
  EXPECT_EQ(car_.front.left_nm, 0.0) << "110 ms";
  EXPECT_TRUE(car_.heartbeat);
  Run(9);
  EXPECT_TRUE(car_.heartbeat) << "200 ms";
  Run(1);
  EXPECT_FALSE(car_.heartbeat) << "210 ms";
}

TEST_F(DISABLED_SocketCan, DeadmanCountsWallTimeOnASilentBus) {
  Drive();
  car_talks_ = stack_talks_ = false;
  const int64_t start = clock_.NowMicros();
  while (Emergency().empty() && clock_.NowMicros() - start < 1'000'000) {
    node_->Poll();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const int64_t took = clock_.NowMicros() - start;
  EXPECT_EQ(Emergency(), "the CAN bus is silent");
  EXPECT_GT(took, 80'000);
  std::cout << "silent bus noticed after " << took / 1000 << " ms\n";
  Tick(false);
  EXPECT_EQ(car_.front.left_nm, 0.0);
}

TEST_F(DISABLED_SocketCan, DrivesOnWith5PercentOfTheFramesLost) {
  Open("vxcan0", "vxcan1");
  strict_ = false;
  state_ = as_state_t::STATE_READY;
  Run(30);
  state_ = as_state_t::STATE_DRIVING;
  int64_t imus = 0;
  stack_.Subscribe(channels::kImu, [&](const imu_t&) { ++imus; });
  constexpr int kTicks = 1'000;
  Run(kTicks);
  const double lost =
      1.0 - static_cast<double>(gateway_port_->counts().received) / static_cast<double>(sent_);
  std::cout << 100.0 * lost << " % lost, " << imus << " of " << kTicks << " IMU\n";
  EXPECT_GT(lost, 0.03);
  EXPECT_LT(lost, 0.07);
  EXPECT_GT(imus, kTicks * 85 / 100) << "of two frames each";
  EXPECT_EQ(Emergency(), "");
  EXPECT_EQ(node_->gateway().supervision().stop(), "");
  EXPECT_NEAR(car_.front.left_nm, 20.0, 0.02);
}

TEST_F(DISABLED_SocketCan, LeavesTheBusNeutralThenSilentOnSigterm) {
  Run(2);
  node_.reset();
  Process daemon({HAIRPIN_BINARY_DIR "/bin/can_gateway", "--config-dir",
                  HAIRPIN_SOURCE_DIR "/config", "--set", "interface=vcan0"});
  bool heard = false;
  const auto listen = [&] {
    while (const auto frame = car_port_->Receive()) {
      heard = true;
      car_.Hear(frame->frame, false);
    }
  };
  for (int i = 0; i < 1'000 && !heard; ++i) {
    now_ += kTick;
    car_port_->Send(car_.Frames(now_, ++ticks_));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    listen();
  }
  ASSERT_TRUE(heard) << "the daemon answers with neutral orders";
  daemon.Signal(SIGTERM);
  EXPECT_EQ(daemon.Wait(20'000), 0);
  listen();
  car_.Listen();
  EXPECT_FALSE(car_.front.enable);
  EXPECT_EQ(car_.brake.level_percent, 50.0);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  listen();
  EXPECT_EQ(car_.frames, 0);
}

}  // namespace
}  // namespace hairpin
