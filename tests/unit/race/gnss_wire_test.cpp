// The simulated receiver against the driver: what each was written to by itself.
#include <gtest/gtest.h>

#include <cmath>

#include "common/geometry.hpp"
#include "daemons/gnss_driver/gnss_driver.hpp"
#include "tools/simulator/gnss_receiver.hpp"

namespace hairpin {
namespace {

constexpr GeodeticPoint kOrigin{49.3295, 8.573, 150.0};
constexpr int64_t kStart = 1'700'000'000'000'000;
constexpr GnssErrorModel kErrors{.single_m = 2.5,
                                 .differential_m = 1.0,
                                 .float_m = 0.3,
                                 .rtk_m = 0.015,
                                 .vertical_factor = 1.5,
                                 .velocity_mps = 0.05,
                                 .heading_rad = 0.005};

gnss_t Measured(int epoch) {
  gnss_t measured{};
  measured.utime = kStart + 100'000 * epoch;
  measured.fix = gnss_t::FIX_RTK;
  const double angle = 0.3 * epoch;  // round the compass, and across the origin
  const double position[] = {40.0 * std::sin(angle), -25.0 * std::cos(angle), 0.4};
  const double velocity[] = {12.0 * std::cos(angle), 7.5 * std::sin(angle), 0.0};
  for (int i = 0; i < 3; ++i) {
    measured.position_enu_m[i] = position[i];
    measured.position_sigma_m[i] = i == 2 ? 0.035 : 0.02;
    measured.velocity_enu_mps[i] = velocity[i];
    measured.velocity_sigma_mps[i] = 0.05;
  }
  measured.heading_valid = epoch % 7 != 3;
  measured.heading_rad = WrapAngle(angle);
  measured.heading_sigma_rad = 0.005;
  return measured;
}

class SimulatedReceiver : public testing::TestWithParam<GnssProtocol> {};

TEST_P(SimulatedReceiver, IsUnderstoodByTheDriver) {
  const GnssReceiver receiver({GetParam(), kOrigin});
  const LocalEnu plane(kOrigin);
  GnssDecoder decoder(kErrors);
  constexpr int kEpochs = 60;
  int heard = 0;
  for (int epoch = 0; epoch < kEpochs; ++epoch) {
    for (const GnssFix& fix : decoder.Add(receiver.Epoch(Measured(epoch)))) {
      const gnss_t truth = Measured(heard++);
      EXPECT_EQ(fix.utime, truth.utime);
      EXPECT_EQ(fix.type, FixType::kRtk);
      const Eigen::Vector3d position = plane.ToEnu(fix.position);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(position[i], truth.position_enu_m[i], 0.012);
        EXPECT_NEAR(fix.position_sigma[i], truth.position_sigma_m[i], 0.001);
        EXPECT_NEAR(fix.velocity[i], truth.velocity_enu_mps[i], 0.001);
        EXPECT_NEAR(fix.velocity_sigma[i], truth.velocity_sigma_mps[i], 1e-9);
      }
      ASSERT_EQ(fix.heading.has_value(), truth.heading_valid != 0) << fix.utime;
      if (!fix.heading) continue;
      EXPECT_NEAR(WrapAngle(*fix.heading - truth.heading_rad), 0.0, 1e-6);
      EXPECT_NEAR(fix.heading_sigma, 0.005, 1e-6);
    }
  }
  EXPECT_EQ(heard, kEpochs) << "the first comes with the second, all others at once";
  EXPECT_TRUE(decoder.bad().empty());
}

INSTANTIATE_TEST_SUITE_P(Protocols, SimulatedReceiver,
                         testing::Values(GnssProtocol::kUbx, GnssProtocol::kNmea),
                         [](const auto& instance) {
                           return instance.param == GnssProtocol::kUbx ? "Ubx" : "Nmea";
                         });

}  // namespace
}  // namespace hairpin
