#include "daemons/velocity_estimator/velocity_estimator_node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "tests/unit/velocity_estimator/simulated_drive.hpp"

namespace hairpin {
namespace {

using ::testing::HasSubstr;

class VelocityEstimatorNodeTest : public testing::Test {
 protected:
  VelocityEstimatorNodeTest() : drive_(ShippedParams().estimator.car, HardLap) {
    pit_.Subscribe(channels::kVelocity,
                   [this](const velocity_t& message) { velocities_.push_back(message); });
  }

  void Send(const ImuReading& reading) {
    imu_t message{};
    message.utime = reading.utime;
    message.acceleration_mps2[0] = reading.acceleration.x();
    message.acceleration_mps2[1] = reading.acceleration.y();
    message.angular_rate_radps[2] = reading.yaw_rate;
    car_.Publish(channels::kImu, message);
  }
  void Send(const GroundSpeedReading& reading) {
    ground_speed_t message{};
    message.utime = reading.utime;
    message.velocity_mps[0] = reading.velocity.x();
    message.velocity_mps[1] = reading.velocity.y();
    message.quality = 1.0;
    car_.Publish(channels::kGroundSpeed, message);
  }
  void Send(const MotorsReading& reading) {
    motors_t message{};
    message.utime = reading.utime;
    std::copy(reading.speed.begin(), reading.speed.end(), message.wheel_speed_radps);
    if (reading.torque)
      std::copy(reading.torque->begin(), reading.torque->end(), message.wheel_torque_nm);
    car_.Publish(channels::kMotors, message);
  }
  void Send(const SteeringReading& reading) {
    steering_t message{};
    message.utime = reading.utime;
    message.wheel_angle_rad = reading.angle;
    car_.Publish(channels::kSteering, message);
  }
  void Send(const GnssReading& reading) {
    gnss_t message{};
    message.utime = reading.utime;
    message.fix = gnss_t::FIX_RTK;
    message.velocity_enu_mps[0] = reading.velocity_enu.x();
    message.velocity_enu_mps[1] = reading.velocity_enu.y();
    message.velocity_sigma_mps[0] = message.velocity_sigma_mps[1] = 0.05;
    message.heading_valid = 1;
    message.heading_rad = reading.heading;
    message.heading_sigma_rad = reading.heading_sigma;
    car_.Publish(channels::kGnss, message);
  }

  void SendTick(bool with_imu = true) {
    drive_.Step();
    const Readings readings = drive_.Measure();
    Send(*readings.motors);
    Send(*readings.steering);
    Send(*readings.ground_speed);
    if (readings.gnss) Send(*readings.gnss);
    if (with_imu) Send(*readings.imu);
    utime_ = readings.imu->utime;
    transport_.Drain();
  }

  int64_t Refused(const std::string& channel) const {
    for (const channel_health_t& health : bus_.Health()) {
      if (health.channel == channel) return health.refused;
    }
    return -1;
  }

  Transport transport_{"memq://"};
  Bus car_{transport_, "can_gateway", 1};
  Bus pit_{transport_, "pit", 2};
  Bus bus_{transport_, "velocity_estimator", 3};
  VelocityEstimatorNode node_{ShippedParams(), bus_};
  SimulatedDrive drive_;
  int64_t utime_ = 0;
  std::vector<velocity_t> velocities_;
};

TEST_F(VelocityEstimatorNodeTest, AnswersEachImuMessageAtItsTime) {
  for (int tick = 1; tick <= 300; ++tick) {
    SendTick();
    ASSERT_EQ(velocities_.size(), static_cast<size_t>(tick));
    ASSERT_EQ(velocities_.back().utime, utime_);
  }
  const velocity_t& last = velocities_.back();
  EXPECT_TRUE(last.valid);
  EXPECT_NEAR(last.vx_mps, drive_.Step().velocity.vx, 0.2);
  EXPECT_GT(last.vx_mps, 5.0);
  EXPECT_EQ(last.gyro_state, velocity_t::SENSOR_USED);
  EXPECT_EQ(last.accelerometer_state, velocity_t::SENSOR_USED);
  EXPECT_EQ(last.ground_speed_state, velocity_t::SENSOR_USED);
  EXPECT_EQ(last.motors_state, velocity_t::SENSOR_USED);
  EXPECT_EQ(last.gnss_state, velocity_t::SENSOR_USED);
  const Eigen::Map<const Eigen::Matrix3d> covariance(last.covariance);
  EXPECT_EQ(covariance, covariance.transpose());
  EXPECT_EQ(Eigen::Matrix3d(covariance).llt().info(), Eigen::Success);
}

TEST_F(VelocityEstimatorNodeTest, SaysNothingValidWithTheImuAlone) {
  for (int tick = 0; tick < 100; ++tick) {
    drive_.Step();
    Send(*drive_.Measure().imu);
  }
  transport_.Drain();
  ASSERT_EQ(velocities_.size(), 100u);
  for (const velocity_t& velocity : velocities_) {
    EXPECT_FALSE(velocity.valid);
    EXPECT_EQ(velocity.ground_speed_state, velocity_t::SENSOR_SILENT);
  }
}

TEST_F(VelocityEstimatorNodeTest, IsLedByOtherSensorsWhileTheImuIsSilent) {
  for (int tick = 0; tick < 300; ++tick) SendTick();
  for (int tick = 0; tick < 100; ++tick) SendTick(false);
  // Silent after 50 ms; from then on one for each period, not one for each message.
  ASSERT_EQ(velocities_.size(), 395u);
  EXPECT_TRUE(velocities_.back().valid);
  EXPECT_EQ(velocities_.back().gyro_state, velocity_t::SENSOR_SILENT);
  for (int tick = 0; tick < 300; ++tick) SendTick();
  EXPECT_EQ(velocities_.back().gyro_state, velocity_t::SENSOR_USED);
  for (size_t i = 1; i < velocities_.size(); ++i)
    ASSERT_GT(velocities_[i].utime, velocities_[i - 1].utime);
  EXPECT_EQ(velocities_.back().utime, utime_);
}

TEST_F(VelocityEstimatorNodeTest, RefusesAbsurdReadingsAndCountsThem) {
  for (int tick = 0; tick < 300; ++tick) SendTick();
  const velocity_t before = velocities_.back();
  Send(GroundSpeedReading{utime_ + 1000, {1e6, 0.0}});
  Send(GroundSpeedReading{utime_ + 1000, {0.0, -51.0}});
  Send(MotorsReading{utime_ + 1000, {1e6, 0.0, 0.0, 0.0}, {}});
  Send(MotorsReading{utime_ + 1000, {}, Wheels{0.0, 0.0, 0.0, 1e4}});
  Send(SteeringReading{utime_ + 1000, 3.0});
  Send(GnssReading{utime_ + 1000, {1e6, 0.0}, {0.0, 0.0}, 0.0, 0.01});
  Send(GnssReading{utime_ + 1000, {1.0, 0.0}, {0.0, 0.0}, 0.0, -0.01});
  Send(ImuReading{utime_ + 1000, {1e3, 0.0}, 0.0});
  Send(ImuReading{utime_ + 1000, {0.0, 0.0}, 100.0});
  transport_.Drain();
  EXPECT_EQ(Refused("GROUND_SPEED"), 2);
  EXPECT_EQ(Refused("MOTORS"), 2);
  EXPECT_EQ(Refused("STEERING"), 1);
  EXPECT_EQ(Refused("GNSS"), 2);
  EXPECT_EQ(Refused("IMU"), 2);
  EXPECT_EQ(velocities_.size(), 300u);
  SendTick();
  EXPECT_NEAR(velocities_.back().vx_mps, before.vx_mps, 0.2);
}

TEST_F(VelocityEstimatorNodeTest,
       RefusesGnssWithoutFixOrHeadingAndAnOpticalSensorThatSeesNoGround) {
  SendTick();
  gnss_t gnss{};
  gnss.utime = utime_ + 1000;
  gnss.fix = gnss_t::FIX_NONE;
  gnss.heading_valid = 1;
  car_.Publish(channels::kGnss, gnss);
  gnss.fix = gnss_t::FIX_RTK;
  gnss.heading_valid = 0;
  car_.Publish(channels::kGnss, gnss);
  ground_speed_t ground_speed{};
  ground_speed.utime = utime_ + 1000;
  ground_speed.quality = 0.1;
  car_.Publish(channels::kGroundSpeed, ground_speed);
  transport_.Drain();
  EXPECT_EQ(Refused("GNSS"), 2);
  EXPECT_EQ(Refused("GROUND_SPEED"), 1);
}

TEST_F(VelocityEstimatorNodeTest, RefusesTimesThatGoBackAndLateReadings) {
  for (int tick = 0; tick < 50; ++tick) SendTick();
  Send(ImuReading{utime_, {0.0, 0.0}, 0.0});
  Send(ImuReading{utime_ - 5000, {0.0, 0.0}, 0.0});
  Send(GroundSpeedReading{utime_ - 5000, {0.0, 0.0}});
  transport_.Drain();
  EXPECT_EQ(Refused("IMU"), 2);
  EXPECT_EQ(Refused("GROUND_SPEED"), 1);
  EXPECT_EQ(velocities_.size(), 50u);
}

TEST(VelocityEstimatorConfig, RefusesWhatIsOutOfRangeByKey) {
  const auto load = [](const std::string& override_value) {
    return LoadVelocityEstimatorParams(
        Config::Load(HAIRPIN_SOURCE_DIR "/config", "velocity_estimator", {override_value}));
  };
  const auto problem = [&load](const std::string& override_value) -> std::string {
    try {
      load(override_value);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem("sensor_noise.gyro_radps=0.01"), "");
  EXPECT_THAT(problem("sensor_noise.gyro_radps=0"), HasSubstr("sensor_noise.gyro_radps"));
  EXPECT_THAT(problem("time.max_gap_s=10"), HasSubstr("time.max_gap_s"));
  EXPECT_THAT(problem("slip.friction=sticky"), HasSubstr("slip.friction"));
}

}  // namespace
}  // namespace hairpin
