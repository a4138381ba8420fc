#include <gtest/gtest.h>

#include <limits>

#include "tests/support/gateway_rig.hpp"

namespace hairpin {
namespace {

constexpr int64_t kStart = 1'700'000'000'000'000;
constexpr int64_t kMs = 1'000;

TEST(CarClock, HasNoTimeBeforeTheBusTellsIt) {
  CarClock clock;
  EXPECT_EQ(clock.Now(1), 0);
  EXPECT_FALSE(clock.Unwrap(5));
}

TEST(CarClock, AdvancesWithWhatIsMeasuredAndNotWithTheWall) {
  CarClock clock;
  clock.Heard(1'000 * kMs);
  EXPECT_EQ(clock.SetTime(kStart, 1'000 * kMs), "");
  clock.Advance(kStart + 10 * kMs, 1'010 * kMs);
  EXPECT_EQ(clock.Now(1'050 * kMs), kStart + 10 * kMs);
  EXPECT_EQ(clock.Unwrap(ToSampleTime(kStart + 20 * kMs)), kStart + 20 * kMs);
}

TEST(CarClock, GoesOnByTheWallWhereTheBusIsSilent) {
  CarClock clock;
  clock.Heard(1'000 * kMs);
  clock.SetTime(kStart, 1'000 * kMs);
  EXPECT_EQ(clock.Now(1'050 * kMs), kStart);
  EXPECT_EQ(clock.Now(1'051 * kMs), kStart + 51 * kMs);
  EXPECT_DOUBLE_EQ(clock.Silence(1'051 * kMs), 0.051);
}

TEST(CarClock, GoesOnByTheWallWhereFramesFlowButTheirTimeStandsStill) {
  CarClock clock;
  clock.Heard(0);
  clock.SetTime(kStart, 1'000 * kMs);
  for (int64_t wall = 1'000; wall <= 1'500; wall += 10) {
    clock.Heard(wall * kMs);
    clock.SetTime(kStart, wall * kMs);
    EXPECT_EQ(clock.Now(wall * kMs), kStart) << "so a simulator may think";
  }
  clock.Heard(1'501 * kMs);
  EXPECT_EQ(clock.Now(1'501 * kMs), kStart + 501 * kMs);
}

TEST(CarClock, TakesAJumpOnlyWhenItIsSaidThreeTimes) {
  CarClock clock;
  clock.SetTime(kStart, 0);
  const int epoch = clock.epoch();
  const int64_t other = kStart - 3'600'000 * kMs;
  EXPECT_EQ(clock.SetTime(other, 0), "time jumps");
  EXPECT_EQ(clock.SetTime(kStart + 100 * kMs, 0), "");
  EXPECT_EQ(clock.SetTime(other, 0), "time jumps");
  EXPECT_EQ(clock.SetTime(other + 100 * kMs, 0), "time jumps");
  EXPECT_EQ(clock.SetTime(other + 200 * kMs, 0), "");
  EXPECT_EQ(clock.Now(0), other + 200 * kMs);
  EXPECT_EQ(clock.epoch(), epoch + 1);
}

TEST(CarClock, RefusesSampleTimesFarFromItsOwn) {
  CarClock clock;
  clock.SetTime(kStart, 0);
  const auto at = [&clock](int64_t ms) { return clock.Unwrap(ToSampleTime(kStart + ms * kMs)); };
  EXPECT_TRUE(at(150));
  EXPECT_FALSE(at(151));
  EXPECT_TRUE(at(-200));
  EXPECT_FALSE(at(-201));
}

CommandLimits Limits() { return {0.5, 100.0, 5.0, 1'000.0, 10.0}; }

TEST(CommandLimiter, LetsPassWhatIsWithinTheLimits) {
  CommandLimiter limiter(Limits());
  const DriveOrder order{0.04, {9.0, -9.0, 9.0, 9.0}, 0.5};
  const DriveOrder passed = limiter.Limit(order, 0.01, false);
  EXPECT_EQ(passed.steering_angle, order.steering_angle);
  EXPECT_EQ(passed.wheel_torque, order.wheel_torque);
  EXPECT_EQ(passed.brake, order.brake);
  EXPECT_TRUE(limiter.counts().empty());
}

TEST(CommandLimiter, LimitsValuesAndNamesEach) {
  CommandLimiter limiter(Limits());
  const DriveOrder passed = limiter.Limit({9.0, {900.0, -900.0, 0.0, 0.0}, 7.0}, 10.0, false);
  EXPECT_EQ(passed.steering_angle, 0.5);
  EXPECT_EQ(passed.wheel_torque[0], 100.0);
  EXPECT_EQ(passed.wheel_torque[1], -100.0);
  EXPECT_EQ(passed.brake, 1.0);
  EXPECT_EQ(limiter.counts().at("steering value"), 1);
  EXPECT_EQ(limiter.counts().at("torque value"), 2);
  EXPECT_EQ(limiter.counts().at("brake value"), 1);
}

TEST(CommandLimiter, LimitsRatesButNeverLettingGoNorBraking) {
  CommandLimiter limiter(Limits());
  limiter.Reset({0.0, {50.0, -50.0, 0.0, 0.0}, 0.0});
  const DriveOrder passed = limiter.Limit({0.4, {0.0, 0.0, 80.0, -80.0}, 1.0}, 0.01, false);
  EXPECT_DOUBLE_EQ(passed.steering_angle, 0.05);
  EXPECT_EQ(passed.wheel_torque[0], 0.0) << "let go at once";
  EXPECT_EQ(passed.wheel_torque[1], 0.0);
  EXPECT_DOUBLE_EQ(passed.wheel_torque[2], 10.0);
  EXPECT_DOUBLE_EQ(passed.wheel_torque[3], -10.0);
  EXPECT_EQ(passed.brake, 1.0) << "brake at once";
  EXPECT_DOUBLE_EQ(limiter.Limit({}, 0.01, false).brake, 0.9);
  EXPECT_EQ(limiter.counts().at("brake rate"), 1);
  EXPECT_EQ(limiter.counts().at("torque rate"), 2);
  EXPECT_EQ(limiter.counts().at("steering rate"), 1);
}

TEST(CommandLimiter, TakesNoDrivingTorqueInAControlledStop) {
  CommandLimiter limiter(Limits());
  const DriveOrder passed = limiter.Limit({0.0, {5.0, -5.0, 0.0, 0.0}, 0.0}, 0.01, true);
  EXPECT_EQ(passed.wheel_torque[0], 0.0);
  EXPECT_EQ(passed.wheel_torque[1], -5.0);
  EXPECT_EQ(limiter.counts().at("torque in a controlled stop"), 1);
}

TEST(CommandLimiter, RefusesLimitsThatAreNone) {
  CommandLimits limits = Limits();
  limits.torque_rate = 0.0;
  EXPECT_THROW(CommandLimiter{limits}, std::invalid_argument);
}

class Decoder : public testing::Test {
 protected:
  std::optional<Measurement> Take(const CanFrame& frame) { return decoder_.Take({frame, 0}); }
  void SetTime(int64_t utime) {
    Take(time_.Pack({.time = static_cast<uint64_t>(utime / kSampleTimeMicros)}));
  }
  int64_t Refused(const std::string& what) {
    const auto found = decoder_.refusals().find(what);
    return found == decoder_.refusals().end() ? 0 : found->second;
  }
  FrameDecoder decoder_{0.25};
  dbc::Sender<dbc::CarTime> time_;
};

TEST_F(Decoder, PutsAnImuTogetherByItsSampleTime) {
  SetTime(kStart);
  const uint16_t time = ToSampleTime(kStart + 3 * kMs);
  EXPECT_FALSE(Take(dbc::Pack(dbc::ImuAcceleration{.sample_time = time, .x_mps2 = 2.0})));
  const auto measurement =
      Take(dbc::Pack(dbc::ImuAngularRate{.sample_time = time, .z_radps = 0.3}));
  ASSERT_TRUE(measurement);
  const auto& imu = std::get<ImuSample>(*measurement);
  EXPECT_EQ(imu.utime, kStart + 3 * kMs) << "when it was measured";
  EXPECT_NEAR(imu.acceleration[0], 2.0, 1e-9);
  EXPECT_NEAR(imu.angular_rate[2], 0.3, 1e-9);
}

TEST_F(Decoder, GivesNoImuOfTwoTimes) {
  SetTime(kStart);
  Take(dbc::Pack(dbc::ImuAcceleration{.sample_time = ToSampleTime(kStart)}));
  EXPECT_FALSE(Take(dbc::Pack(dbc::ImuAngularRate{.sample_time = ToSampleTime(kStart + kMs)})));
}

TEST_F(Decoder, RefusesFramesBeforeItKnowsTheTime) {
  EXPECT_FALSE(Take(dbc::Pack(dbc::SteeringAngle{.sample_time = 5})));
  EXPECT_EQ(Refused("STEERING_ANGLE: sample time far from the car's"), 1);
}

TEST_F(Decoder, RefusesASensorWhoseTimeStandsStill) {
  SetTime(kStart);
  const CanFrame frame = dbc::Pack(dbc::OpticalSpeed{.sample_time = ToSampleTime(kStart)});
  EXPECT_TRUE(Take(frame));
  EXPECT_FALSE(Take(frame));
  EXPECT_EQ(Refused("OPTICAL_SPEED: sample time does not advance"), 1);
}

TEST_F(Decoder, CountsByNameWhatIsWrongWithAFrame) {
  SetTime(kStart);
  dbc::Sender<dbc::SteeringAngle> steering;
  CanFrame frame = steering.Pack({.sample_time = ToSampleTime(kStart)});
  EXPECT_TRUE(Take(frame));
  frame.length = 3;
  Take(frame);
  frame.length = 8;
  Take(frame);
  frame.data[0] ^= 1u;
  Take(frame);
  Take({0x7FF, 0, {}});
  EXPECT_EQ(Refused("STEERING_ANGLE: length"), 1);
  EXPECT_EQ(Refused("STEERING_ANGLE: counter repeats"), 1);
  EXPECT_EQ(Refused("STEERING_ANGLE: checksum"), 1);
  EXPECT_EQ(Refused("another frame: not in the database"), 1);
  EXPECT_EQ(decoder_.refused(), 4);
}

TEST_F(Decoder, TakesALostResForAStopAndLostBrakesForBadOnes) {
  SetTime(kStart);
  dbc::Sender<dbc::VehicleStatus> vehicle;
  dbc::Sender<dbc::ResStatus> res;
  dbc::Sender<dbc::Brakes> brakes;
  Take(res.Pack({.sample_time = ToSampleTime(kStart), .go = true}));
  Take(brakes.Pack({.sample_time = ToSampleTime(kStart), .engaged = true, .ok = true}));
  const auto at = [&](int64_t ms) {
    return std::get<VehicleSample>(
        *Take(vehicle.Pack({.sample_time = ToSampleTime(kStart + ms * kMs), .mission = 6})));
  };
  const VehicleSample fresh = at(140);
  EXPECT_TRUE(fresh.res_go && fresh.brakes_ok && fresh.brakes_engaged && !fresh.res_stop);
  EXPECT_EQ(fresh.mission, 6);
  const VehicleSample lost = at(160);
  EXPECT_TRUE(!lost.res_go && lost.res_stop && !lost.brakes_ok && !lost.brakes_engaged);
}

TEST_F(Decoder, ReportsTheSpeedOfTheWheels) {
  SetTime(kStart);
  const uint16_t time = ToSampleTime(kStart);
  Take(dbc::Pack(
      dbc::WheelSpeedsFront{.sample_time = time, .left_radps = 40.0, .right_radps = 40.0}));
  Take(dbc::Pack(
      dbc::WheelSpeedsRear{.sample_time = time, .left_radps = 44.0, .right_radps = -4.0}));
  const auto sample = Take(dbc::Pack(dbc::VehicleStatus{.sample_time = time}));
  EXPECT_DOUBLE_EQ(std::get<VehicleSample>(*sample).speed, 0.25 * 32.0);
}

TEST(IdsOfTheCar, AreThoseThatTheComputerDoesNotSend) {
  const std::vector<uint32_t> ids = IdsOfTheCar();
  EXPECT_EQ(ids.size(), 13u);
  EXPECT_EQ(std::count(ids.begin(), ids.end(), dbc::CarTime::kId), 1);
  EXPECT_EQ(std::count(ids.begin(), ids.end(), dbc::Heartbeat::kId), 0);
}

TEST(CanGatewayParams, OutOfBoundsAreRefused) {
  const auto refused = [](auto change) {
    CanGatewayParams params = ShippedCanGatewayParams();
    change(params);
    EXPECT_THROW(CanGateway{params}, std::invalid_argument);
  };
  refused([](auto& p) { p.wheel_radius = 0.0; });
  refused([](auto& p) { p.stop_brake = 1.5; });
  refused([](auto& p) { p.limits.steering_rate = -1.0; });
  refused([](auto& p) { p.supervision.bus_silence = 0.0; });
  refused([](auto& p) { p.supervision.deadman.silent_after = 0.01; });
  refused([](auto& p) { p.monitor.diverging_factor = 1.0; });
  refused([](auto& p) { p.monitor.settling_time = std::numeric_limits<double>::quiet_NaN(); });
}

}  // namespace
}  // namespace hairpin
