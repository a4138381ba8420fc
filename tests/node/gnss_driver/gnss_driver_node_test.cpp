#include "daemons/gnss_driver/gnss_driver_node.hpp"

#include <gmock/gmock.h>
#include <pty.h>
#include <unistd.h>

#include <array>
#include <numbers>

namespace hairpin {
namespace {

/// The receiver's end of a pseudo terminal.
class Receiver {
 public:
  Receiver() {
    std::array<char, 128> name{};
    if (openpty(&master_, &slave_, name.data(), nullptr, nullptr) != 0) std::abort();
    path_ = name.data();
  }
  ~Receiver() { Unplug(); }
  void Say(const std::string& text) {
    ASSERT_EQ(write(master_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void Unplug() {
    if (master_ >= 0) close(master_);
    if (slave_ >= 0) close(slave_);
    master_ = slave_ = -1;
  }
  const std::string& path() const { return path_; }

 private:
  int master_ = -1;
  int slave_ = -1;
  std::string path_;
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
    listener_.Subscribe(channels::kHeartbeat, [](const heartbeat_t&) {});
  }
  void Poll(GnssDriverNode& node) {
    node.Poll();
    transport_.Drain();
  }

  Transport transport_{"memq://"};
  Bus bus_{transport_, "gnss_driver", 1};
  Bus listener_{transport_, "test", 2};
  ManualClock clock_;
  std::vector<gnss_t> fixes_;
};

TEST_F(GnssDriverNodeTest, PublishesWhatComesFromATerminal) {
  Receiver receiver;
  GnssDriverParams params = Params(receiver.path());
  params.antenna_baseline_yaw = std::numbers::pi / 2.0;
  GnssDriverNode node(params, bus_, clock_);
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

TEST_F(GnssDriverNodeTest, ComesBackWhenTheReceiverDoes) {
  auto receiver = std::make_unique<Receiver>();
  GnssDriverNode node(Params(receiver->path()), bus_, clock_);
  receiver->Unplug();
  Poll(node);
  EXPECT_TRUE(node.descriptors().empty());
  const Receiver again;  // usually the same name; if not, there is nothing to come back to
  clock_.Set(2'000'000);
  Poll(node);
  EXPECT_EQ(node.descriptors().size(), again.path() == receiver->path() ? 1U : 0U);
}

TEST_F(GnssDriverNodeTest, StartsWithoutItsPort) {
  GnssDriverNode node(Params("/dev/no_such_port"), bus_, clock_);
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
