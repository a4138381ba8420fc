#include "daemons/lidar_driver/udp_receiver.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <thread>

#include "daemons/lidar_driver/lidar_driver_process.hpp"
#include "tests/support/own_network.hpp"
#include "tests/support/velodyne_packets.hpp"

namespace hairpin {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

constexpr uint16_t kPort = 2368;
constexpr int kBuffer = 2 << 20;

/// Sends from an address of the loopback network.
class UdpSender {
 public:
  explicit UdpSender(const char* address) : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in from{};
    from.sin_family = AF_INET;
    inet_pton(AF_INET, address, &from.sin_addr);
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&from), sizeof from) != 0)
      throw std::runtime_error("cannot send from there");
  }
  ~UdpSender() { close(socket_); }
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  void Send(const Bytes& packet, uint16_t port = kPort) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const ssize_t sent = sendto(socket_, packet.data(), packet.size(), 0,
                                reinterpret_cast<const sockaddr*>(&to), sizeof to);
    ASSERT_EQ(sent, static_cast<ssize_t>(packet.size()));
  }

 private:
  int socket_;
};

int64_t HostTime() {
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  return int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
}

/// True where the kernel, and not the read, stamped a packet within 5 s. The kernel turns its
/// stamping on in the background once a first socket asks for it.
bool WaitForKernelStamps(UdpReceiver& receiver) {
  const UdpSender sender("127.0.0.1");
  bool stamped = false;
  for (int i = 0; i < 1000 && !stamped; ++i) {
    sender.Send({0});
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const int64_t read = HostTime();
    receiver.Receive(1, [&](const LidarPacket& packet) { stamped = packet.receive_utime < read; });
  }
  return stamped;
}

TEST(UdpReceiver, HandsOnPayloadSenderAndWhenTheKernelGotIt) {
  if (!InOwnNetwork()) return RunInOwnNetwork();
  UdpReceiver receiver(kPort, kBuffer);
  ASSERT_TRUE(WaitForKernelStamps(receiver));
  const int64_t before = HostTime();
  UdpSender("127.0.0.7").Send({1, 2, 3});
  UdpSender("127.0.0.8").Send({});
  const int64_t after = HostTime();
  std::vector<Bytes> payloads;
  std::vector<std::optional<uint32_t>> senders;
  receiver.Receive(10, [&](const LidarPacket& packet) {
    payloads.emplace_back(packet.payload.begin(), packet.payload.end());
    senders.push_back(packet.sender);
    EXPECT_GE(packet.receive_utime, before);
    EXPECT_LE(packet.receive_utime, after);
  });
  EXPECT_EQ(payloads, (std::vector<Bytes>{{1, 2, 3}, {}}));
  EXPECT_EQ(senders, (std::vector{ParseIpv4("127.0.0.7"), ParseIpv4("127.0.0.8")}));
  EXPECT_EQ(receiver.overflows(), 0u);
}

TEST(UdpReceiver, EndsAPollAfterSoManyPacketsAndDoesNotWaitForMore) {
  if (!InOwnNetwork()) return RunInOwnNetwork();
  UdpReceiver receiver(kPort, kBuffer);
  const UdpSender sender("127.0.0.1");
  for (int i = 0; i < 30; ++i) sender.Send(Bytes(1206));
  int taken = 0;
  const auto count = [&](const LidarPacket&) { ++taken; };
  receiver.Receive(20, count);
  EXPECT_EQ(taken, 20);
  receiver.Receive(20, count);
  EXPECT_EQ(taken, 30);
  receiver.Receive(20, count);
  EXPECT_EQ(taken, 30);
}

TEST(UdpReceiver, CountsWhatAFloodLeftNoRoomFor) {
  if (!InOwnNetwork()) return RunInOwnNetwork();
  UdpReceiver receiver(kPort, 20'000);
  const UdpSender sender("127.0.0.1");
  constexpr uint32_t kSent = 2000;
  for (uint32_t i = 0; i < kSent; ++i) sender.Send(Bytes(1206));
  uint32_t taken = 0;
  const auto count = [&](const LidarPacket&) { ++taken; };
  receiver.Receive(kSent, count);
  EXPECT_GT(taken, 0u);
  EXPECT_LT(taken, kSent);
  sender.Send(Bytes(1206));  // each packet says how many were dropped before it
  receiver.Receive(1, count);
  EXPECT_EQ(taken + receiver.overflows(), kSent + 1);
}

TEST(UdpReceiver, NamesAPortThatIsTaken) {
  if (!InOwnNetwork()) return RunInOwnNetwork();
  const UdpReceiver first(kPort, kBuffer);
  try {
    const UdpReceiver second(kPort, kBuffer);
    FAIL() << "two on one port";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("UDP port 2368: cannot listen: "));
  }
}

TEST(Ipv4, IsFourNumbersAndNothingElse) {
  EXPECT_EQ(ParseIpv4("192.168.1.201"), 0xc0a801c9u);
  for (const char* text : {"", "any", "192.168.1", "192.168.1.256", "192.168.1.201 ", "::1"})
    EXPECT_FALSE(ParseIpv4(text)) << text;
}

/// The driver's process on its sockets, and a sensor at 127.0.0.1.
class DriverOnTheWire {
 public:
  DriverOnTheWire() {
    listener_.Subscribe(channels::kLidarFront, [this](const lidar_scan_t&) { ++scans_; });
  }
  void Poll() {
    process_.Poll();
    transport_.Drain();
  }
  int scans() const { return scans_; }
  channel_health_t Health() const {
    for (const channel_health_t& health : bus_.Health())
      if (health.channel == "packets") return health;
    return {};
  }

 private:
  Transport transport_{"memq://"};
  Bus bus_{transport_, "lidar_driver_front", 1};
  Bus listener_{transport_, "listener", 2};
  ManualClock clock_;
  LidarDriverProcess process_{Config::Load(HAIRPIN_SOURCE_DIR "/config", "lidar_driver",
                                           {"gnss_wait_s=0", "front.sensor_address=127.0.0.1"}),
                              bus_, "", clock_};
  int scans_ = 0;
};

TEST(LidarDriverProcess, HearsItsSensorAmongForeignSendersAndWrongSizes) {
  if (!InOwnNetwork()) return RunInOwnNetwork();
  DriverOnTheWire driver;
  const UdpSender sensor("127.0.0.1"), foreign("127.0.0.2");
  VelodyneSource source;
  int foreign_sent = 0, wrong_sent = 0;
  constexpr int kPackets = 460;  // three turns
  for (int i = 0; i < kPackets; ++i) {
    sensor.Send(source.Next());
    if (i % 10 == 0) {
      foreign.Send(VelodyneSource().Next());
      ++foreign_sent;
    }
    if (i % 20 == 0) {
      for (const size_t size : {0u, 1u, 1205u, 1207u, 60'000u}) {
        if (i % 100 != static_cast<int>(20 * (size % 5))) continue;
        sensor.Send(Bytes(size, 0xff));
        ++wrong_sent;
      }
    }
    if (i % 20 == 19) driver.Poll();
  }
  sensor.Send(VelodynePosition(source.time_us, "GPRMC,,V,,,,,,,,,,N"), 8308);
  driver.Poll();
  ASSERT_GT(wrong_sent, 5);
  EXPECT_EQ(driver.scans(), 2) << "the first turn was not seen from its beginning";
  EXPECT_EQ(driver.Health().received, kPackets + 1);
  EXPECT_EQ(driver.Health().refused, foreign_sent);
  EXPECT_EQ(driver.Health().undecodable, wrong_sent);
  EXPECT_EQ(driver.Health().missing, 0);
}

// By FAULTS 12 a foreign sender's packets are bad ones: too many, and the sensor counts as stale.
TEST(LidarDriverProcess, GoesOnAfterAForeignSendersFloodHasEnded) {
  if (!InOwnNetwork()) return RunInOwnNetwork();
  DriverOnTheWire driver;
  const UdpSender sensor("127.0.0.1"), foreign("127.0.0.2");
  VelodyneSource source;
  const auto turns = [&](int count, int flood) {
    for (int i = 0; i < 151 * count; ++i) {
      sensor.Send(source.Next());
      for (int k = 0; k < flood; ++k) foreign.Send(Bytes(1206, 0xee));
      if (i % 10 == 9) driver.Poll();
    }
    driver.Poll();
    const int scans = driver.scans();
    return scans;
  };
  const int before = turns(3, 0);
  EXPECT_GE(before, 2);
  const int meanwhile = turns(3, 2);
  EXPECT_LE(meanwhile, before + 1);
  EXPECT_GE(turns(4, 0), meanwhile + 2);
  EXPECT_EQ(driver.Health().refused, 3 * 151 * 2);
}

}  // namespace
}  // namespace hairpin
