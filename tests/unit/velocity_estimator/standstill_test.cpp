#include "daemons/velocity_estimator/standstill.hpp"

#include <gtest/gtest.h>

namespace hairpin {
namespace {

constexpr StandstillParams kParams{.hold = 0.3,
                                   .max_wheel_speed = 0.4,
                                   .max_ground_speed = 0.25,
                                   .max_wheel_torque = 10.0,
                                   .max_yaw_rate = 0.03,
                                   .max_acceleration = 0.4,
                                   .velocity_sigma = 0.01,
                                   .yaw_rate_sigma = 0.002,
                                   .bias_window = 5.0,
                                   .max_gyro_bias = 0.01,
                                   .max_accelerometer_bias = 0.2};

bool StandsAfterASecond(const ImuReading& imu, const std::optional<MotorsReading>& motors) {
  Standstill standstill(kParams);
  ImuReading reading = imu;
  bool stands = false;
  for (int i = 0; i < 100; ++i) {
    reading.utime += 10'000;
    stands = standstill.Detect(reading, motors);
  }
  return stands;
}

TEST(Standstill, NeedsQuietWheelsAndAQuietImu) {
  const ImuReading quiet{0, {0.1, 0.1}, 0.01};
  const MotorsReading still{};
  EXPECT_TRUE(StandsAfterASecond(quiet, still));
  EXPECT_FALSE(StandsAfterASecond(quiet, std::nullopt));
  EXPECT_FALSE(StandsAfterASecond({0, {-0.5, 0.0}, 0.0}, still)) << "sliding on locked wheels";
  EXPECT_FALSE(StandsAfterASecond({0, {0.0, 0.0}, -0.04}, still));
  for (size_t wheel = 0; wheel < 4; ++wheel) {
    MotorsReading motors;
    motors.speed[wheel] = -0.5;
    EXPECT_FALSE(StandsAfterASecond(quiet, motors)) << wheel;
    motors.speed[wheel] = 0.0;
    motors.torque.emplace()[wheel] = 12.0;
    EXPECT_FALSE(StandsAfterASecond(quiet, motors)) << wheel;
  }
}

TEST(Standstill, WaitsForTheHoldAndEndsAtOnce) {
  Standstill standstill(kParams);
  ImuReading imu;
  for (imu.utime = 0; imu.utime < 300'000; imu.utime += 10'000)
    EXPECT_FALSE(standstill.Detect(imu, MotorsReading{}));
  EXPECT_TRUE(standstill.Detect(imu, MotorsReading{}));
  imu.utime += 10'000;
  imu.acceleration.x() = 2.0;
  EXPECT_FALSE(standstill.Detect(imu, MotorsReading{}));
  imu.acceleration.x() = 0.0;
  imu.utime += 10'000;
  EXPECT_FALSE(standstill.Detect(imu, MotorsReading{}));
}

TEST(Standstill, AveragesTheBiasesAndBoundsThem) {
  Standstill standstill(kParams);
  for (int i = 0; i < 100; ++i)
    standstill.LearnBias({0, {i % 2 == 0 ? 0.04 : 0.08, -0.03}, i % 2 == 0 ? 0.002 : 0.004}, 0.01);
  EXPECT_NEAR(standstill.gyro_bias(), 0.003, 1e-9);
  EXPECT_TRUE(standstill.accelerometer_bias().isApprox(Eigen::Vector2d(0.06, -0.03), 1e-9));
  for (int i = 0; i < 2000; ++i) standstill.LearnBias({0, {0.3, 0.4}, -0.5}, 0.01);
  EXPECT_DOUBLE_EQ(standstill.gyro_bias(), -0.01);
  EXPECT_TRUE(standstill.accelerometer_bias().isApprox(Eigen::Vector2d(0.12, 0.16), 0.02));
}

}  // namespace
}  // namespace hairpin
