#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/simulator_setup.hpp"
#include "tools/simulator/motion_sensors.hpp"

namespace hairpin {
namespace {

constexpr int kSamples = 20000;

struct Statistics {
  double mean = 0.0;
  double sigma = 0.0;
};

Statistics Measure(const std::function<double(int64_t)>& sample) {
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double value = sample(i);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / kSamples;
  return {mean, std::sqrt(squares / kSamples - mean * mean)};
}

// A motion with every part, so that no lever arm goes unseen.
VehicleState Turning() {
  VehicleState state;
  state.T_map_base = {3.0, 4.0, 0.7};
  state.velocity = {8.0, 0.3, 0.9};
  state.acceleration = {1.0, 7.0};
  state.steering_angle = 0.12;
  state.wheel_speed = {34.0, 36.0, 33.0, 37.0};
  state.wheel_torque = {10.0, 20.0, 30.0, 40.0};
  return state;
}

TEST(MotionSensors, WhiteNoiseIsWhatTheParametersSay) {
  const MotionSensorParams params = ShippedSimulatorParams().motion_sensors;
  MotionSensors sensors(params, ShippedCar(), 1);
  const VehicleState state = Turning();
  const double no_time = 0.0;  // the biases stand still
  const auto near = [](const Statistics& s, double sigma) {
    EXPECT_NEAR(s.sigma, sigma, 0.03 * sigma);
  };
  near(Measure([&](int64_t t) { return sensors.Imu(t, state, no_time).angular_rate_radps[2]; }),
       params.gyro_noise_radps);
  near(Measure([&](int64_t t) { return sensors.Imu(t, state, no_time).acceleration_mps2[1]; }),
       params.accelerometer_noise_mps2);
  near(Measure([&](int64_t t) { return sensors.Motors(t, state).wheel_speed_radps[2]; }),
       params.wheel_speed_noise_radps);
  near(Measure([&](int64_t t) { return sensors.Motors(t, state).wheel_torque_nm[2]; }),
       params.wheel_torque_noise_nm);
  near(Measure([&](int64_t t) { return sensors.Steering(t, state).wheel_angle_rad; }),
       params.steering_noise_rad);
  near(Measure([&](int64_t t) { return sensors.GroundSpeed(t, state).velocity_mps[0]; }),
       params.ground_speed_noise_mps);
  near(Measure([&](int64_t t) { return sensors.Gnss(t, state, no_time).velocity_enu_mps[0]; }),
       params.gnss_velocity_noise_mps);
  near(Measure([&](int64_t t) { return sensors.Gnss(t, state, no_time).heading_rad; }),
       params.gnss_heading_noise_rad);
}

TEST(MotionSensors, MeasureAtTheirMounts) {
  const SimulatorParams shipped = ShippedSimulatorParams();
  MotionSensorParams params = shipped.motion_sensors;
  params.ground_speed_scale = 0.0;
  params.ground_speed_misalignment_rad = 0.0;
  params.gnss_position_bias_m = 0.0;
  Car car = ShippedCar();
  car.ground_speed_position = {-0.5, 0.2};
  car.gnss_position = {-0.3, 0.1};
  MotionSensors sensors(params, car, 1);
  const VehicleState state = Turning();
  const Eigen::Vector2d expected_ground(8.0 - 0.9 * 0.2, 0.3 + 0.9 * -0.5);
  const Eigen::Vector2d expected_gnss =
      state.T_map_base.rotation() * Eigen::Vector2d(8.0 - 0.9 * 0.1, 0.3 - 0.9 * 0.3);
  const Eigen::Vector2d expected_position = state.T_map_base * car.gnss_position;
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(
        Measure([&](int64_t t) { return sensors.GroundSpeed(t, state).velocity_mps[i]; }).mean,
        expected_ground[i], 0.003);
    EXPECT_NEAR(
        Measure([&](int64_t t) { return sensors.Gnss(t, state, 0.0).velocity_enu_mps[i]; }).mean,
        expected_gnss[i], 0.003);
    EXPECT_NEAR(
        Measure([&](int64_t t) { return sensors.Gnss(t, state, 0.0).position_enu_m[i]; }).mean,
        expected_position[i], 0.003);
  }
}

TEST(MotionSensors, ErrorsOfARunStayWithinDataSheetsOverManySeeds) {
  const MotionSensorParams params = ShippedSimulatorParams().motion_sensors;
  const VehicleState still{};
  double squares = 0.0;
  constexpr int kSeeds = 300;
  for (int seed = 0; seed < kSeeds; ++seed) {
    MotionSensors sensors(params, ShippedCar(), static_cast<uint64_t>(seed));
    double sum = 0.0;
    for (int i = 0; i < 400; ++i) sum += sensors.Imu(i, still, 0.0).angular_rate_radps[2];
    squares += std::pow(sum / 400.0, 2.0);
  }
  const double expected = std::hypot(params.gyro_bias_radps, params.gyro_noise_radps / 20.0);
  EXPECT_NEAR(std::sqrt(squares / kSeeds), expected, 0.12 * expected);
}

TEST(MotionSensors, DeclareTheirGnssCovariance) {
  const MotionSensorParams params = ShippedSimulatorParams().motion_sensors;
  MotionSensors sensors(params, ShippedCar(), 1);
  const gnss_t gnss = sensors.Gnss(5, Turning(), 0.1);
  EXPECT_EQ(gnss.velocity_sigma_mps[1], params.gnss_velocity_noise_mps);
  EXPECT_EQ(gnss.heading_sigma_rad, params.gnss_heading_noise_rad);
  EXPECT_GT(gnss.position_sigma_m[0], params.gnss_position_bias_m);
  EXPECT_TRUE(gnss.heading_valid);
  EXPECT_EQ(gnss.utime, 5);
}

TEST(MotionSensors, DoNotDisturbEachOther) {
  const MotionSensorParams params = ShippedSimulatorParams().motion_sensors;
  MotionSensors one(params, ShippedCar(), 9);
  MotionSensors other(params, ShippedCar(), 9);
  const VehicleState state = Turning();
  for (int i = 0; i < 10; ++i) {
    one.Motors(i, state);
    one.Gnss(i, state, 0.1);
    EXPECT_EQ(one.Imu(i, state, 0.01).angular_rate_radps[2],
              other.Imu(i, state, 0.01).angular_rate_radps[2]);
  }
}

TEST(MotionSensors, RefuseParametersThatCannotBe) {
  MotionSensorParams params = ShippedSimulatorParams().motion_sensors;
  params.gyro_noise_radps = -1.0;
  EXPECT_THROW(MotionSensors(params, ShippedCar(), 1), std::invalid_argument);
  params = ShippedSimulatorParams().motion_sensors;
  params.imu_bias_time_s = 0.0;
  EXPECT_THROW(MotionSensors(params, ShippedCar(), 1), std::invalid_argument);
}

TEST(RandomStream, IsNormalAndUniform) {
  RandomStream random(1, "test");
  const Statistics normal = Measure([&](int64_t) { return random.Gaussian(2.0); });
  EXPECT_NEAR(normal.mean, 0.0, 0.05);
  EXPECT_NEAR(normal.sigma, 2.0, 0.04);
  const Statistics uniform = Measure([&](int64_t) { return random.Uniform(1.0, 3.0); });
  EXPECT_NEAR(uniform.mean, 2.0, 0.02);
  EXPECT_NEAR(uniform.sigma, 2.0 / std::sqrt(12.0), 0.01);
}

TEST(RandomStream, GivesTheSameNumbersOnEveryMachine) {
  EXPECT_DOUBLE_EQ(RandomStream(42, "imu").Uniform(), 0.16830492071101633);
}

TEST(RandomStream, DependsOnSeedAndName) {
  const double first = RandomStream(42, "imu").Uniform();
  EXPECT_NE(first, RandomStream(43, "imu").Uniform());
  EXPECT_NE(first, RandomStream(42, "gnss").Uniform());
}

TEST(WanderingBias, KeepsItsSpreadForEver) {
  RandomStream random(3, "bias");
  WanderingBias bias(0.5, 2.0, random);
  const Statistics statistics = Measure([&](int64_t) { return bias.Step(1.0, random); });
  EXPECT_NEAR(statistics.mean, 0.0, 0.03);
  EXPECT_NEAR(statistics.sigma, 0.5, 0.02);
}

}  // namespace
}  // namespace hairpin
