#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/unit/velocity_estimator/simulated_drive.hpp"

namespace hairpin {
namespace {

// One sensor goes wrong at 8 s, in the middle of hard driving, and is well again at 18 s.
constexpr double kFrom = 8.0;
constexpr double kTo = 18.0;
constexpr double kEnd = 26.0;

std::vector<DriveSample> DriveWith(const Tamper& fault, double end = kEnd) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  SimulatedDrive drive(params.car, HardLap);
  VelocityEstimator estimator(params);
  return Drive(drive, estimator, end, [&fault](double t, Readings& readings) {
    if (t > kFrom && t <= kTo) fault(t, readings);
  });
}

const VelocityEstimate& EstimateAt(const std::vector<DriveSample>& samples, double t) {
  return samples.at(static_cast<size_t>(std::llround(t / SimulatedDrive::kPeriod)) - 1).estimate;
}

/// Largest change of the error from one period to the next around the start of the fault [m/s].
double StepAt(const std::vector<DriveSample>& samples, double t) {
  double step = 0.0;
  for (size_t i = static_cast<size_t>(t * 100.0) - 2; i < static_cast<size_t>(t * 100.0) + 30;
       ++i) {
    const auto error = [&samples](size_t k) {
      const Twist2& e = samples[k].estimate.velocity;
      const Twist2& v = samples[k].truth.velocity;
      return Eigen::Vector2d(e.vx - v.vx, e.vy - v.vy);
    };
    step = std::max(step, (error(i + 1) - error(i)).norm());
  }
  return step;
}

void ExpectAllUsed(const SensorStates& states) {
  EXPECT_EQ(states.gyro, SensorState::kUsed);
  EXPECT_EQ(states.accelerometer, SensorState::kUsed);
  EXPECT_EQ(states.ground_speed, SensorState::kUsed);
  EXPECT_EQ(states.motors, SensorState::kUsed);
  EXPECT_EQ(states.gnss, SensorState::kUsed);
}

/// Bounds while the fault lasts: maximum error of vx and vy [m/s], RMS error of the yaw rate
/// [rad/s].
void ExpectWithin(const std::vector<DriveSample>& samples, double velocity, double yaw_rate_rms) {
  const DriveErrors errors = ErrorsOf(samples, kFrom, kTo);
  EXPECT_LE(errors.vx_max, velocity);
  EXPECT_LE(errors.vy_max, velocity);
  EXPECT_LE(errors.yaw_rate_rms, yaw_rate_rms);
  for (const DriveSample& sample : samples) ASSERT_TRUE(sample.estimate.valid) << sample.truth.t;
}

TEST(VelocityFaults, DrivesOnWithoutTheOpticalSensor) {
  const auto samples = DriveWith([](double, Readings& readings) { readings.ground_speed.reset(); });
  ExpectWithin(samples, 0.25, 0.009);
  EXPECT_EQ(EstimateAt(samples, 8.05).states.ground_speed, SensorState::kUsed);
  EXPECT_EQ(EstimateAt(samples, 8.06).states.ground_speed, SensorState::kSilent);
  EXPECT_LT(StepAt(samples, kFrom), 0.05);
  EXPECT_GT(EstimateAt(samples, 17.95).covariance(1, 1),
            2.0 * EstimateAt(samples, 7.95).covariance(1, 1));
  ExpectAllUsed(EstimateAt(samples, 20.0).states);
}

TEST(VelocityFaults, DrivesOnWithoutTheWheels) {
  const auto samples = DriveWith([](double, Readings& readings) { readings.motors.reset(); });
  ExpectWithin(samples, 0.15, 0.009);
  EXPECT_LT(StepAt(samples, kFrom), 0.05);
  EXPECT_EQ(EstimateAt(samples, 8.06).states.motors, SensorState::kSilent);
}

TEST(VelocityFaults, DrivesOnWithoutGnss) {
  const auto samples = DriveWith([](double, Readings& readings) { readings.gnss.reset(); });
  ExpectWithin(samples, 0.15, 0.009);
  EXPECT_LT(StepAt(samples, kFrom), 0.05);
  EXPECT_EQ(EstimateAt(samples, 8.30).states.gnss, SensorState::kSilent);
}

TEST(VelocityFaults, KeepsTheLateralVelocityByTheRearTyresWhereNoSensorMeasuresIt) {
  const auto samples = DriveWith([](double, Readings& readings) {
    readings.ground_speed.reset();
    readings.gnss.reset();
  });
  // This car's tyres are several times softer than the parameters say.
  ExpectWithin(samples, 0.4, 0.009);
  EXPECT_LT(StepAt(samples, kFrom), 0.05);
}

TEST(VelocityFaults, DrivesOnWithoutSteeringAndMotorCurrents) {
  const auto samples = DriveWith([](double, Readings& readings) {
    readings.steering.reset();
    readings.motors->torque.reset();
  });
  ExpectWithin(samples, 0.15, 0.009);
  ExpectAllUsed(EstimateAt(samples, 17.0).states);
}

TEST(VelocityFaults, DrivesOnWithoutSteering) {
  const auto samples = DriveWith([](double, Readings& readings) { readings.steering.reset(); });
  ExpectWithin(samples, 0.15, 0.009);
  ExpectAllUsed(EstimateAt(samples, 17.0).states);
}

TEST(VelocityFaults, DrivesOnWithoutTheImu) {
  const auto samples = DriveWith([](double, Readings& readings) { readings.imu.reset(); });
  ExpectWithin(samples, 0.25, 0.06);
  EXPECT_LT(StepAt(samples, kFrom), 0.08);
  EXPECT_EQ(EstimateAt(samples, 8.06).states.gyro, SensorState::kSilent);
  EXPECT_GT(EstimateAt(samples, 12.0).covariance(2, 2),
            10.0 * EstimateAt(samples, 7.95).covariance(2, 2));
}

TEST(VelocityFaults, GrowsTheCovarianceUntilInvalidWhereEverySpeedIsGone) {
  const auto samples = DriveWith(
      [](double, Readings& readings) {
        readings.ground_speed.reset();
        readings.motors.reset();
        readings.gnss.reset();
        readings.imu->acceleration = {
            30.0 * std::sin(static_cast<double>(readings.imu->utime % 1000003)),
            0.0};  // nor any acceleration
      },
      kTo);
  double last = EstimateAt(samples, kFrom + 0.1).covariance(0, 0);
  for (double t = kFrom + 0.2; t < kFrom + 1.0; t += 0.1) {
    EXPECT_GT(EstimateAt(samples, t).covariance(0, 0), last) << t;
    last = EstimateAt(samples, t).covariance(0, 0);
  }
  EXPECT_FALSE(EstimateAt(samples, kTo).valid);
}

struct ScaleFault {
  std::string name;
  SensorState SensorStates::*state;
  Tamper scale;
  double velocity;
};

class ScaledSensor : public testing::TestWithParam<ScaleFault> {};

TEST_P(ScaledSensor, IsRejectedWithinASecondAndTakenBack) {
  const auto samples = DriveWith(GetParam().scale);
  ExpectWithin(samples, GetParam().velocity, 0.009);
  EXPECT_EQ(EstimateAt(samples, kFrom + 1.1).states.*GetParam().state, SensorState::kRejected);
  EXPECT_EQ(EstimateAt(samples, kTo).states.*GetParam().state, SensorState::kRejected);
  ExpectAllUsed(EstimateAt(samples, kTo + 2.5).states);
}

INSTANTIATE_TEST_SUITE_P(VelocityFaults, ScaledSensor,
                         testing::Values(ScaleFault{"Optical", &SensorStates::ground_speed,
                                                    [](double, Readings& readings) {
                                                      readings.ground_speed->velocity *= 1.3;
                                                    },
                                                    0.25},
                                         ScaleFault{"Wheels", &SensorStates::motors,
                                                    [](double, Readings& readings) {
                                                      for (double& speed : readings.motors->speed)
                                                        speed *= 1.3;
                                                    },
                                                    0.15},
                                         ScaleFault{"Gnss", &SensorStates::gnss,
                                                    [](double, Readings& readings) {
                                                      if (readings.gnss)
                                                        readings.gnss->velocity_enu *= 1.3;
                                                    },
                                                    0.15}),
                         [](const auto& fault) { return fault.param.name; });

double Ramp(double t) { return 1.0 + 0.03 * (t - kFrom); }

TEST(VelocityFaults, RejectsWheelsThatDriftSlowly) {
  const auto samples = DriveWith([](double t, Readings& readings) {
    for (double& speed : readings.motors->speed) speed *= Ramp(t);
  });
  ExpectWithin(samples, 0.2, 0.009);
  EXPECT_EQ(EstimateAt(samples, kFrom + 4.0).states.motors, SensorState::kRejected);
}

TEST(VelocityFaults, RejectsAnOpticalSensorThatDriftsSlowlyThoughItIsTheBestOne) {
  const auto samples =
      DriveWith([](double t, Readings& readings) { readings.ground_speed->velocity *= Ramp(t); });
  // Until it is found out the filter follows it, by what the tolerances of the vote allow.
  ExpectWithin(samples, 0.8, 0.009);
  for (double t = kFrom + 4.0; t < kTo; t += 0.1) {
    EXPECT_EQ(EstimateAt(samples, t).states.ground_speed, SensorState::kRejected) << t;
    EXPECT_EQ(EstimateAt(samples, t).states.gnss, SensorState::kUsed) << t;
  }
  EXPECT_LE(ErrorsOf(samples, kFrom + 4.0, kTo).vx_max, 0.2);
}

TEST(VelocityFaults, RejectsAGyroWithAWrongScaleInACorner) {
  const auto samples = DriveWith([](double, Readings& readings) { readings.imu->yaw_rate *= 1.3; });
  ExpectWithin(samples, 0.2, 0.08);
  EXPECT_EQ(EstimateAt(samples, 14.0).states.gyro, SensorState::kRejected);
  ExpectAllUsed(EstimateAt(samples, 22.0).states);
}

TEST(VelocityFaults, RejectsAnAccelerometerWithAWrongScaleRatherThanAllOthers) {
  const auto samples =
      DriveWith([](double, Readings& readings) { readings.imu->acceleration *= 1.3; });
  ExpectWithin(samples, 0.25, 0.009);
  for (double t = kFrom; t < kTo; t += 0.1) {
    EXPECT_EQ(EstimateAt(samples, t).states.ground_speed, SensorState::kUsed) << t;
    EXPECT_EQ(EstimateAt(samples, t).states.gyro, SensorState::kUsed) << t;
  }
}

/// The last reading before the fault, again and again with fresh stamps.
template <class Reading>
std::vector<DriveSample> DriveFrozen(std::optional<Reading> Readings::*sensor) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  SimulatedDrive drive(params.car, HardLap);
  VelocityEstimator estimator(params);
  std::optional<Reading> frozen;
  return Drive(drive, estimator, kEnd, [&](double t, Readings& readings) {
    std::optional<Reading>& reading = readings.*sensor;
    if (!reading) return;
    if (t <= kFrom) frozen = reading;
    if (t <= kFrom || t > kTo) return;
    frozen->utime = reading->utime;
    reading = frozen;
  });
}

TEST(VelocityFaults, NoticesAFrozenOpticalSensor) {
  const auto samples = DriveFrozen(&Readings::ground_speed);
  ExpectWithin(samples, 0.25, 0.009);
  EXPECT_EQ(EstimateAt(samples, kFrom + 1.3).states.ground_speed, SensorState::kRejected);
  ExpectAllUsed(EstimateAt(samples, kTo + 2.5).states);
}

TEST(VelocityFaults, NoticesFrozenWheels) {
  const auto samples = DriveFrozen(&Readings::motors);
  ExpectWithin(samples, 0.15, 0.009);
  EXPECT_EQ(EstimateAt(samples, kFrom + 1.3).states.motors, SensorState::kRejected);
}

TEST(VelocityFaults, NoticesFrozenGnss) {
  const auto samples = DriveFrozen(&Readings::gnss);
  ExpectWithin(samples, 0.15, 0.009);
  EXPECT_EQ(EstimateAt(samples, kFrom + 1.5).states.gnss, SensorState::kRejected);
}

TEST(VelocityFaults, NoticesAFrozenImuRatherThanRejectingAllOthers) {
  const auto samples = DriveFrozen(&Readings::imu);
  ExpectWithin(samples, 0.25, 0.06);
  EXPECT_EQ(EstimateAt(samples, kFrom + 1.3).states.gyro, SensorState::kRejected);
  EXPECT_EQ(EstimateAt(samples, kFrom + 1.3).states.accelerometer, SensorState::kRejected);
  EXPECT_EQ(EstimateAt(samples, kFrom + 1.3).states.ground_speed, SensorState::kUsed);
}

TEST(VelocityFaults, IgnoresSpikes) {
  const auto samples = DriveWith([](double t, Readings& readings) {
    const long tick = std::lround(t * 100.0);
    if (tick % 37 == 0) readings.imu->yaw_rate += 2.0;
    if (tick % 41 == 0) readings.imu->acceleration.x() += 30.0;
    if (tick % 43 == 0) readings.ground_speed->velocity.x() += 5.0;
    if (tick % 47 == 0) readings.motors->speed[1] += 60.0;
    if (tick % 70 == 0) readings.gnss->velocity_enu.y() += 8.0;
  });
  ExpectWithin(samples, 0.15, 0.012);
  for (const DriveSample& sample : samples) {
    if (sample.truth.t > kFrom) ExpectAllUsed(sample.estimate.states);
  }
}

TEST(VelocityFaults, IsNotMisledByAWheelThatSpins) {
  const auto one = DriveWith([](double, Readings& readings) { readings.motors->speed[2] *= 1.3; });
  ExpectWithin(one, 0.15, 0.009);
  ExpectAllUsed(EstimateAt(one, kTo).states);
  const auto axle_under_torque = DriveWith([](double, Readings& readings) {
    for (const size_t i : {2u, 3u}) {
      readings.motors->speed[i] *= 1.3;
      readings.motors->torque.value()[i] = 280.0;
    }
  });
  ExpectWithin(axle_under_torque, 0.15, 0.009);
}

TEST(VelocityFaults, TellsLockedWheelsFromStandstill) {
  const auto samples = DriveWith([](double, Readings& readings) {
    readings.motors->speed = {};
    readings.motors->torque = Wheels{};
  });
  ExpectWithin(samples, 0.15, 0.009);
}

}  // namespace
}  // namespace hairpin
