// The gateway against the kernel's own CAN, in user-mode-linux: the machine that tests need not
// have any. One boot runs all tests named DISABLED_SocketCan; the gateway is the node itself, on
// its port; the car sits on the other end of vcan0.
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>

#include "tests/support/process.hpp"
#include "tests/system/can_gateway/socketcan_rig.hpp"

namespace hairpin {
namespace {

constexpr int kBootPatienceMs = 180'000;
constexpr int64_t kStateTimeout = 150'000;  // three periods of a state of the car

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

using DISABLED_SocketCan = SocketCan;

TEST_F(DISABLED_SocketCan, FiltersInTheKernelWhatIsNotOfTheCar) {
  Drive();
  const int64_t before = port_->counts().received;
  const RawSocket stranger("vcan0");
  for (uint32_t id = 0; id < 0x800; ++id) {
    const std::vector<uint32_t> ids = IdsOfTheCar();
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) stranger.Send(id);
  }
  for (const uint32_t id : IdsOfTheCar()) {
    stranger.Send(id | CAN_EFF_FLAG);
    stranger.Send(id | CAN_RTR_FLAG);
  }
  Drain();
  EXPECT_EQ(port_->counts().received, before);
  stranger.Send(dbc::CarTime::kId, 3);
  Drain();
  EXPECT_EQ(port_->counts().received, before + 1);
}

TEST_F(DISABLED_SocketCan, StampsFramesWhenTheKernelTookThem) {
  car_port_->Send(car_.Frames(now_, 1));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const auto frame = port_->Receive();
  ASSERT_TRUE(frame);
  EXPECT_GE(clock_.NowMicros() - frame->arrival_micros, 45'000) << "not when it was read";
}

TEST_F(DISABLED_SocketCan, LosesNoFrameOfALap) {
  Drive();
  constexpr int kLap = 3'400;  // 34 s
  Run(kLap);
  EXPECT_EQ(port_->counts().received, sent_);
  EXPECT_EQ(port_->counts().overflowed, 0);
  EXPECT_EQ(car_port_->counts().received, port_->counts().sent);
  EXPECT_EQ(port_->counts().unsent, 0);
  EXPECT_EQ(gateway_.decoder().refused(), 0);
  EXPECT_EQ(imus_, kLap + 60);
  EXPECT_EQ(motors_, kLap + 60);
  EXPECT_EQ(vehicles_, (kLap + 60) / 5);
  EXPECT_EQ(Emergency(), "");
  std::cout << sent_ << " frames in, " << port_->counts().sent << " out\n";
}

TEST_F(DISABLED_SocketCan, KeepsTheCarDrivingInAFloodOf5000FramesASecond) {
  Drive();
  const int64_t before = port_->counts().received;
  const int64_t sent_before = sent_;
  std::atomic<bool> stop = false;
  int64_t flood = 0;
  const MonotonicClock wall;
  const int64_t start = wall.NowMicros();
  std::thread flooder([&] {
    SocketCanPort stranger("vcan0", {0x7FF}, wall);
    const std::vector<CanFrame> frames(100, CanFrame{0x600, 8, {}});
    while (!stop) {
      stranger.Send(frames);
      flood = stranger.counts().sent;
      const int64_t due = start + (flood + stranger.counts().unsent) * 200 - wall.NowMicros();
      if (due > 0) std::this_thread::sleep_for(std::chrono::microseconds(due));  // 5000 a second
    }
  });
  while (wall.NowMicros() - start < 2'000'000) {
    Tick();
    std::this_thread::sleep_for(std::chrono::milliseconds(8));
  }
  stop = true;
  flooder.join();
  const double seconds = static_cast<double>(wall.NowMicros() - start) * 1e-6;
  std::cout << flood << " foreign frames in " << seconds << " s\n";
  EXPECT_GT(static_cast<double>(flood), 4'500.0 * seconds);
  EXPECT_EQ(port_->counts().received - before, sent_ - sent_before)
      << "the kernel keeps the flood out, and loses nothing";
  EXPECT_EQ(port_->counts().overflowed, 0);
  EXPECT_EQ(Emergency(), "");
  EXPECT_TRUE(car_.heartbeat);
}

TEST_F(DISABLED_SocketCan, CountsErrorFramesThatAreHarmless) {
  Drive();
  const RawSocket controller("vcan0");
  controller.Send(CAN_ERR_FLAG | CAN_ERR_CRTL);
  Run(2);
  EXPECT_EQ(port_->counts().error_frames, 1);
  EXPECT_EQ(port_->state(), CanState::kActive);
  EXPECT_EQ(Emergency(), "");
}

TEST_F(DISABLED_SocketCan, BusOffWhileDrivingEndsTheHeartbeatAndNothingOldComesOutAfterwards) {
  Drive();
  const RawSocket controller("vcan0");
  controller.Send(CAN_ERR_FLAG | CAN_ERR_BUSOFF | CAN_ERR_CRTL);
  const int64_t sent = port_->counts().sent;
  Run(20);
  EXPECT_EQ(port_->state(), CanState::kBusOff);
  EXPECT_EQ(port_->counts().bus_offs, 1);
  EXPECT_EQ(port_->counts().sent, sent) << "nothing is sent, nothing is kept";
  EXPECT_GT(port_->counts().unsent, 0);
  EXPECT_EQ(Emergency(), "CAN bus-off");
  controller.Send(CAN_ERR_FLAG | CAN_ERR_RESTARTED);
  strict_ = false;  // the counters have jumped
  torques_.clear();
  Run(20);
  EXPECT_EQ(port_->state(), CanState::kActive);
  ASSERT_FALSE(torques_.empty());
  for (const CanFrame& frame : torques_) {
    dbc::TorqueCommandFront torque;
    ASSERT_EQ(dbc::Unpack(frame, torque), "");
    EXPECT_EQ(torque.left_nm, 0.0) << "from the first on";
    EXPECT_FALSE(torque.enable);
  }
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
  EXPECT_EQ(port_->state(), CanState::kDown);
  EXPECT_FALSE(car_.heartbeat);
  ASSERT_EQ(std::system("ip link set vcan0 up"), 0);
  strict_ = false;
  Run(50);
  EXPECT_EQ(port_->state(), CanState::kActive);
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
  Run(9);
  EXPECT_EQ(Emergency(), "") << "90 ms";
  Run(2);
  EXPECT_EQ(Emergency(), "the CAN bus is silent") << "110 ms";
  EXPECT_EQ(car_.front.left_nm, 0.0);
  EXPECT_FALSE(car_.heartbeat);
}

TEST_F(DISABLED_SocketCan, DrivesOnWith5PercentOfTheFramesLost) {
  Open("vxcan0", "vxcan1");
  strict_ = false;
  state_ = as_state_t::STATE_READY;
  Run(30);
  state_ = as_state_t::STATE_DRIVING;
  constexpr int kTicks = 1'000;
  Run(kTicks);
  const double lost =
      1.0 - static_cast<double>(port_->counts().received) / static_cast<double>(sent_);
  std::cout << 100.0 * lost << " % lost, " << imus_ << " of " << kTicks << " IMU\n";
  EXPECT_GT(lost, 0.03);
  EXPECT_LT(lost, 0.07);
  EXPECT_GT(imus_, kTicks * 85 / 100) << "of two frames each";
  // Which frames are lost is the kernel's dice: three of one state in a row are one run in twelve,
  // and then the car is to stop [FAULTS 30].
  if (longest_silence_ > kStateTimeout) {
    EXPECT_NE(Emergency().find("has ceased"), std::string::npos) << Emergency();
    return;
  }
  EXPECT_EQ(Emergency(), "");
  EXPECT_EQ(gateway_.supervision().stop(), "");
  EXPECT_NEAR(car_.front.left_nm, 20.0, 0.02);
}

TEST_F(DISABLED_SocketCan, LeavesTheBusNeutralThenSilentOnSigterm) {
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
