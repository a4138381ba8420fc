#include "daemons/gnss_driver/gnss_driver_node.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <optional>

#include "common/daemon.hpp"
#include "daemons/gnss_driver/gnss_driver_process.hpp"
#include "tools/simulator/pseudo_terminal.hpp"

namespace hairpin {
namespace {

class Receiver {
 public:
  void Say(const std::string& text) {
    const auto* bytes = reinterpret_cast<const uint8_t*>(text.data());
    ASSERT_EQ(terminal_->Write({bytes, text.size()}), text.size());
  }
  void Unplug() { terminal_.reset(); }
  std::string path() const { return terminal_->path(); }

 private:
  std::optional<PseudoTerminal> terminal_{std::in_place};
};

GnssDriverParams Params(const std::string& port) {
  GnssDriverParams params =
      LoadGnssDriverParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "gnss_driver"));
  params.port = port;
  return params;
}

std::string Epoch(const std::string& time, double minutes_north) {
  const std::string latitude = "47" + std::to_string(minutes_north);
  return NmeaFrame("GPGGA," + time + "," + latitude +
                   ",N,00838.888800,E,4,12,0.8,440.1,M,47.9,M,,") +
         NmeaFrame("GPRMC," + time + ",A,,,,,10.0,0.0,241126,,,R") + NmeaFrame("GPHDT,0.0,T");
}

class GnssDriverNodeTest : public testing::Test {
 protected:
  GnssDriverNodeTest() {
    listener_.Subscribe(channels::kGnss, [this](const gnss_t& fix) { fixes_.push_back(fix); });
    listener_.Subscribe(channels::kHeartbeat,
                        [this](const heartbeat_t& message) { heartbeat_ = message; });
  }
  void Poll(GnssDriverProcess& node) {
    node.Poll();
    transport_.Drain();
  }

  Transport transport_{"memq://"};
  Bus bus_{transport_, "gnss_driver", 1};
  Bus listener_{transport_, "test", 2};
  ManualClock clock_;
  std::vector<gnss_t> fixes_;
  heartbeat_t heartbeat_{};
};

TEST_F(GnssDriverNodeTest, PublishesWhatComesFromATerminal) {
  Receiver receiver;
  GnssDriverParams params = Params(receiver.path());
  params.antenna_baseline_yaw = std::numbers::pi / 2.0;
  GnssDriverProcess node(params, bus_, clock_);
  ASSERT_EQ(node.descriptors().size(), 1U);
  receiver.Say(Epoch("123519.20", 23.7664) + Epoch("123519.30", 23.7670));
  Poll(node);
  ASSERT_EQ(fixes_.size(), 2U);
  EXPECT_EQ(fixes_[0].utime, 1'795'523'719'200'000);
  EXPECT_EQ(fixes_[0].fix, gnss_t::FIX_RTK);
  EXPECT_NEAR(fixes_[0].position_enu_m[1], 0.0, 1e-9) << "the origin is the first fix";
  EXPECT_NEAR(fixes_[1].position_enu_m[1], 1.11, 0.01) << "0.0006 minutes to the north";
  EXPECT_NEAR(fixes_[1].velocity_enu_mps[1], 5.144, 1e-3);
  ASSERT_TRUE(fixes_[1].heading_valid);
  EXPECT_NEAR(fixes_[1].heading_rad, 0.0, 1e-9) << "the antennas stand across the car";
}

TEST_F(GnssDriverNodeTest, CountsBadSentencesIntoItsHeartbeat) {
  Receiver receiver;
  Heartbeat heartbeat(bus_, 0);
  GnssDriverProcess node(Params(receiver.path()), bus_, clock_);
  std::string broken = Epoch("123519.30", 23.7664);
  broken.replace(broken.find("23.7"), 4, "99.9");  // the checksum stays
  receiver.Say(Epoch("123519.20", 23.7664) + broken + "$GPGGA,no checksum\r\n" +
               Epoch("123519.40", 23.7664) + Epoch("123519.10", 23.7664) +
               Epoch("123519.50", 23.7664) + Epoch("123519.60", 23.7664));
  Poll(node);
  heartbeat.Send();
  transport_.Drain();
  EXPECT_EQ(heartbeat_.utime, fixes_.back().utime) << "a driver's measurements are the data";
  ASSERT_EQ(heartbeat_.channels.size(), 1U);
  const channel_health_t& serial = heartbeat_.channels[0];
  EXPECT_EQ(serial.channel, "serial");
  EXPECT_EQ(serial.received, static_cast<int64_t>(fixes_.size()));
  EXPECT_EQ(serial.undecodable, 2);
  EXPECT_EQ(serial.implausible_time, 1);
}

TEST_F(GnssDriverNodeTest, ComesBackWhenTheReceiverDoes) {
  auto receiver = std::make_unique<Receiver>();
  GnssDriverProcess node(Params(receiver->path()), bus_, clock_);
  receiver->Unplug();
  Poll(node);
  EXPECT_TRUE(node.descriptors().empty());
  const Receiver again;  // usually the same name; if not, there is nothing to come back to
  clock_.Set(2'000'000);
  Poll(node);
  EXPECT_EQ(node.descriptors().size(), again.path() == receiver->path() ? 1U : 0U);
}

TEST_F(GnssDriverNodeTest, StartsWithoutItsPort) {
  GnssDriverProcess node(Params("/dev/no_such_port"), bus_, clock_);
  EXPECT_TRUE(node.descriptors().empty());
  Poll(node);
  EXPECT_TRUE(fixes_.empty());
}

TEST(GnssDriverConfig, RefusesABaudRateThatIsNone) {
  EXPECT_THROW(LoadGnssDriverParams(
                   Config::Load(HAIRPIN_SOURCE_DIR "/config", "gnss_driver", {"baud_rate=12345"})),
               ConfigError);
}

}  // namespace
}  // namespace hairpin
