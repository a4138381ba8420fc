#include <gtest/gtest.h>

#include <random>

#include "common/can/cannelloni.hpp"
#include "common/can/cannelloni_port.hpp"
#include "common/can/deadman.hpp"
#include "common/can/memory_can_bus.hpp"
#include "common/can/sample_time.hpp"
#include "common/can/socketcan_port.hpp"
#include "tests/support/own_network.hpp"

namespace hairpin {
namespace {

const CanFrame kFrame{0x123, 3, {1, 2, 3}};

TEST(Cannelloni, IsWrittenAsItsFormatSays) {
  const std::vector<uint8_t> expected{2, 0, 9, 0, 1, 0, 0, 0x01, 0x23, 3, 1, 2, 3};
  EXPECT_EQ(EncodeCannelloni(9, {&kFrame, 1}), expected);
}

TEST(Cannelloni, ReadsWhatItWrites) {
  std::mt19937 random(1);
  for (int i = 0; i < 1'000; ++i) {
    std::vector<CanFrame> frames(random() % (kMaxCannelloniFrames + 1));
    for (CanFrame& frame : frames) {
      frame.id = static_cast<uint32_t>(random());
      frame.length = static_cast<uint8_t>(random() % 9);
      const bool remote = (frame.id & CanFrame::kRemote) != 0;
      for (size_t k = 0; k < frame.length && !remote; ++k)
        frame.data[k] = static_cast<uint8_t>(random());
    }
    const auto datagram = DecodeCannelloni(EncodeCannelloni(static_cast<uint8_t>(i), frames));
    ASSERT_TRUE(datagram);
    EXPECT_EQ(datagram->frames, frames);
    EXPECT_EQ(datagram->sequence, static_cast<uint8_t>(i));
  }
}

TEST(Cannelloni, RefusesWhatIsNone) {
  const std::vector<uint8_t> good = EncodeCannelloni(0, {&kFrame, 1});
  const auto changed = [&good](size_t index, uint8_t value) {
    std::vector<uint8_t> bytes = good;
    bytes[index] = value;
    return bytes;
  };
  for (size_t size = 0; size < good.size(); ++size)
    EXPECT_FALSE(DecodeCannelloni({good.data(), size})) << size;
  std::vector<uint8_t> longer = good;
  longer.push_back(0);
  EXPECT_FALSE(DecodeCannelloni(longer));
  EXPECT_FALSE(DecodeCannelloni(changed(0, 1))) << "another version";
  EXPECT_FALSE(DecodeCannelloni(changed(1, 1))) << "an acknowledgement";
  EXPECT_FALSE(DecodeCannelloni(changed(3, 255))) << "more frames than bytes";
  EXPECT_FALSE(DecodeCannelloni(changed(9, 9))) << "longer than classic CAN";
  EXPECT_FALSE(DecodeCannelloni(changed(9, 0x83))) << "CAN FD";
}

TEST(UdpAddress, IsReadStrictly) {
  const UdpAddress address = ParseUdpAddress("127.0.0.1:20000");
  EXPECT_EQ(address.host, "127.0.0.1");
  EXPECT_EQ(address.port, 20'000);
  for (const char* bad : {"", "127.0.0.1", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:70000",
                          "localhost:1", "127.0.0.1:1 "})
    EXPECT_THROW(ParseUdpAddress(bad), std::invalid_argument) << bad;
}

TEST(CannelloniPort, CarriesABurstInOrderAndTakesNothingFromStrangers) {
  if (!InOwnNetwork()) return RunInOwnNetwork();
  const MonotonicClock clock;
  const UdpAddress a{"127.0.0.1", 20'000};
  const UdpAddress b{"127.0.0.1", 20'001};
  CannelloniPort port_a(a, b, clock);
  std::vector<CanFrame> frames(500, kFrame);
  for (size_t i = 0; i < frames.size(); ++i) frames[i].id = static_cast<uint32_t>(i);
  port_a.Send(frames);  // nobody is there yet: lost, and no error later
  CannelloniPort port_b(b, a, clock);
  EXPECT_FALSE(port_b.Receive());
  port_a.Send(frames);
  CannelloniPort stranger({"127.0.0.1", 20'002}, b, clock);
  stranger.Send({&kFrame, 1});
  for (const CanFrame& frame : frames) {
    const auto received = port_b.Receive();
    ASSERT_TRUE(received);
    EXPECT_EQ(received->frame, frame);
  }
  EXPECT_FALSE(port_b.Receive());
  EXPECT_EQ(port_b.counts().received, 500);
  EXPECT_EQ(port_b.counts().malformed, 1);
  EXPECT_FALSE(port_a.Receive());
}

TEST(SocketCanPort, SaysWhichInterfaceCannotBeOpened) {
  const MonotonicClock clock;
  try {
    SocketCanPort port("nocan7", {0x100}, clock);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("nocan7"), std::string::npos) << error.what();
  }
}

TEST(MemoryCanBus, SendsNothingWhileTheBusIsOff) {
  const ManualClock clock;
  MemoryCanBus bus;
  const auto a = bus.Attach(clock);
  const auto b = bus.Attach(clock);
  a->SetState(CanState::kBusOff);
  a->Send({&kFrame, 1});
  a->SetState(CanState::kActive);
  EXPECT_FALSE(b->Receive()) << "and nothing was kept for later";
  EXPECT_EQ(a->counts().unsent, 1);
  a->Send({&kFrame, 1});
  EXPECT_TRUE(b->Receive());
}

TEST(SampleTime, IsTheNearestToTheReferenceAcrossEveryWrap) {
  constexpr int64_t kReference = 1'700'000'000'000'000;
  for (int64_t offset = -3'276'800; offset < 3'276'800; offset += 700) {
    const int64_t utime = (kReference + offset) / kSampleTimeMicros * kSampleTimeMicros;
    ASSERT_EQ(FromSampleTime(ToSampleTime(utime), kReference), utime) << offset;
  }
}

TEST(Deadman, ChangesItsStageJustBeyondEachAge) {
  const DeadmanLimits limits{0.05, 0.1, 0.2};
  EXPECT_EQ(StageAt(0.0, limits), DeadmanStage::kFresh);
  EXPECT_EQ(StageAt(0.05, limits), DeadmanStage::kFresh);
  EXPECT_EQ(StageAt(0.0501, limits), DeadmanStage::kHeld);
  EXPECT_EQ(StageAt(0.1, limits), DeadmanStage::kHeld);
  EXPECT_EQ(StageAt(0.1001, limits), DeadmanStage::kNeutral);
  EXPECT_EQ(StageAt(0.2, limits), DeadmanStage::kNeutral);
  EXPECT_EQ(StageAt(0.2001, limits), DeadmanStage::kSilent);
}

TEST(Deadman, RefusesLimitsOutOfOrder) {
  EXPECT_THROW(Check({0.0, 0.1, 0.2}), std::invalid_argument);
  EXPECT_THROW(Check({0.2, 0.1, 0.3}), std::invalid_argument);
  EXPECT_THROW(Check({0.1, 0.3, 0.2}), std::invalid_argument);
  EXPECT_THROW(Check({0.1, 0.2, 2.0}), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
