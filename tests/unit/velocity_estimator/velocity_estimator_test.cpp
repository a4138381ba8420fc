#include "daemons/velocity_estimator/velocity_estimator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "tests/unit/velocity_estimator/simulated_drive.hpp"

namespace hairpin {
namespace {

constexpr double kDegree = 0.017453292519943295;

std::vector<DriveSample> DriveLap(double duration, const Tamper& tamper = {}, DriveNoise noise = {},
                                  uint32_t seed = 1) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  SimulatedDrive drive(params.car, HardLap, noise, seed);
  VelocityEstimator estimator(params);
  return Drive(drive, estimator, duration, tamper);
}

TEST(VelocityEstimator, KnowsTheVelocityOfAHardDrivenLap) {
  for (uint32_t seed = 1; seed <= 5; ++seed) {
    const DriveErrors errors = ErrorsOf(DriveLap(32.0, {}, {}, seed), 0.5, 32.0);
    EXPECT_LE(errors.vx_rms, 0.05) << seed;
    EXPECT_LE(errors.vy_rms, 0.05) << seed;
    EXPECT_LE(errors.yaw_rate_rms, 0.5 * kDegree) << seed;
    EXPECT_LE(errors.vx_max, 0.15) << seed;
    EXPECT_LE(errors.vy_max, 0.15) << seed;
  }
}

TEST(VelocityEstimator, CoversItsErrorsWithItsCovariance) {
  // Biases and tyre slip are not white, so the mean is above 3, the degrees of freedom.
  double nees = 0.0;
  const auto samples = DriveLap(32.0);
  for (const DriveSample& sample : samples) {
    const Twist2& e = sample.estimate.velocity;
    const Twist2& v = sample.truth.velocity;
    const Eigen::Vector3d error(e.vx - v.vx, e.vy - v.vy, e.yaw_rate - v.yaw_rate);
    nees += error.dot(sample.estimate.covariance.llt().solve(error)) /
            static_cast<double>(samples.size());
  }
  EXPECT_GT(nees, 1.0);
  EXPECT_LT(nees, 6.0);
}

TEST(VelocityEstimator, PublishesCovariancesThatAreSymmetricAndPositiveDefinite) {
  const Tamper patchy = [](double t, Readings& readings) {
    if (t > 5.0 && t < 9.0) readings.ground_speed.reset();
    if (t > 7.0 && t < 15.0) readings.gnss.reset();
    if (t > 10.0 && t < 14.0) readings.motors.reset();
    if (t > 12.0 && t < 14.0) readings = {};
  };
  for (const DriveSample& sample : DriveLap(20.0, patchy)) {
    const Eigen::Matrix3d& covariance = sample.estimate.covariance;
    ASSERT_EQ(covariance, covariance.transpose());
    ASSERT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues().minCoeff(),
              0.0);
  }
}

TEST(VelocityEstimator, MirrorsWithItsInputs) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  SimulatedDrive drive(params.car, HardLap);
  VelocityEstimator left(params);
  VelocityEstimator right(params);
  for (int tick = 0; tick < 1000; ++tick) {
    drive.Step();
    const Readings readings = drive.Measure();
    Readings mirrored = readings;
    mirrored.imu.value().yaw_rate *= -1.0;
    mirrored.imu.value().acceleration.y() *= -1.0;
    mirrored.ground_speed.value().velocity.y() *= -1.0;
    mirrored.steering.value().angle *= -1.0;
    for (Wheels* wheels :
         {&mirrored.motors.value().speed, &mirrored.motors.value().torque.value()}) {
      std::swap((*wheels)[0], (*wheels)[1]);
      std::swap((*wheels)[2], (*wheels)[3]);
    }
    if (mirrored.gnss) {
      mirrored.gnss->velocity_enu.y() *= -1.0;
      mirrored.gnss->heading *= -1.0;
    }
    Offer(left, readings);
    Offer(right, mirrored);
    const VelocityEstimate a = left.Advance(readings.imu->utime);
    const VelocityEstimate b = right.Advance(readings.imu->utime);
    // Not to the last digit: the wheels are fused one after another.
    ASSERT_NEAR(a.velocity.vx, b.velocity.vx, 1e-3);
    ASSERT_NEAR(a.velocity.vy, -b.velocity.vy, 1e-3);
    ASSERT_NEAR(a.velocity.yaw_rate, -b.velocity.yaw_rate, 1e-3);
  }
}

TEST(VelocityEstimator, DoesNotDependOnTheOrderOfArrival) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  SimulatedDrive drive(params.car, HardLap);
  VelocityEstimator one(params);
  VelocityEstimator other(params);
  for (int tick = 0; tick < 500; ++tick) {
    drive.Step();
    const Readings readings = drive.Measure();
    Offer(one, readings);
    other.Add(*readings.imu);
    other.Add(*readings.ground_speed);
    if (readings.gnss) other.Add(*readings.gnss);
    other.Add(*readings.steering);
    other.Add(*readings.motors);
    const VelocityEstimate a = one.Advance(readings.imu->utime);
    const VelocityEstimate b = other.Advance(readings.imu->utime);
    ASSERT_EQ(a.velocity.vx, b.velocity.vx);
    ASSERT_EQ(a.velocity.vy, b.velocity.vy);
    ASSERT_EQ(a.covariance, b.covariance);
  }
}

TEST(VelocityEstimator, StandsStillWithoutDriftingAndLearnsTheGyroBias) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  SimulatedDrive drive(params.car, [](double) { return DriveDemand{}; });
  VelocityEstimator estimator(params);
  for (const DriveSample& sample : Drive(drive, estimator, 60.0)) {
    if (sample.truth.t < 1.0) continue;
    ASSERT_TRUE(sample.estimate.valid);
    ASSERT_LT(std::abs(sample.estimate.velocity.vx), 0.02);
    ASSERT_LT(std::abs(sample.estimate.velocity.vy), 0.02);
    ASSERT_LT(std::abs(sample.estimate.velocity.yaw_rate), 0.005);
  }
  EXPECT_NEAR(estimator.gyro_bias(), DriveNoise{}.gyro_bias, 0.0005);
}

TEST(VelocityEstimator, SubtractsTheGyroBiasItHasLearnt) {
  DriveNoise noise;
  noise.gyro_bias = 0.008;
  double sum = 0.0;
  int count = 0;
  for (const DriveSample& sample : DriveLap(12.0, {}, noise)) {
    if (sample.truth.t < 2.5) continue;
    sum += sample.estimate.velocity.yaw_rate - sample.truth.velocity.yaw_rate;
    ++count;
  }
  EXPECT_NEAR(sum / count, 0.0, 0.001);
}

TEST(VelocityEstimator, IsNotValidBeforeSomethingTellsTheVelocity) {
  const auto only_imu = [](double, Readings& readings) {
    readings.ground_speed.reset();
    readings.motors.reset();
    readings.gnss.reset();
  };
  for (const DriveSample& sample : DriveLap(5.0, only_imu)) ASSERT_FALSE(sample.estimate.valid);
}

TEST(VelocityEstimator, ReportsTheSlipOfTheWheels) {
  const auto samples = DriveLap(3.0);
  const DriveSample& launch = samples[280];  // full acceleration since 0.8 s
  EXPECT_GT(launch.truth.slip[2], 0.02);
  for (size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(launch.estimate.slip[i], launch.truth.slip[i], 0.015) << i;
}

TEST(VelocityEstimator, RefusesTimesThatDoNotIncrease) {
  VelocityEstimator estimator(ShippedParams().estimator);
  EXPECT_EQ(estimator.Add(ImuReading{1'000'000, {0.0, 0.0}, 0.0}), Intake::kTaken);
  EXPECT_EQ(estimator.Add(ImuReading{1'000'000, {0.0, 0.0}, 0.0}), Intake::kTimeNotIncreasing);
  EXPECT_EQ(estimator.Add(ImuReading{990'000, {0.0, 0.0}, 0.0}), Intake::kTimeNotIncreasing);
  EXPECT_EQ(estimator.Add(GroundSpeedReading{990'000, {0.0, 0.0}}), Intake::kTaken)
      << "each sensor has its own time";
  estimator.Advance(1'000'000);
  EXPECT_THROW(estimator.Advance(1'000'000), std::invalid_argument);
}

TEST(VelocityEstimator, RefusesWhatIsTooOldOrTooFarAhead) {
  VelocityEstimator estimator(ShippedParams().estimator);
  estimator.Add(ImuReading{10'000'000, {0.0, 0.0}, 0.0});
  estimator.Advance(10'000'000);
  EXPECT_EQ(estimator.Add(GnssReading{9'890'000, {0.0, 0.0}, {0.1, 0.1}, 0.0, 0.0}),
            Intake::kTooOld);
  EXPECT_EQ(estimator.Add(GnssReading{9'910'000, {0.0, 0.0}, {0.1, 0.1}, 0.0, 0.0}),
            Intake::kTaken);
  EXPECT_EQ(estimator.Add(GroundSpeedReading{10'600'000, {0.0, 0.0}}), Intake::kTooFarAhead);
  EXPECT_EQ(estimator.Add(GroundSpeedReading{10'010'000, {0.0, 0.0}}), Intake::kTaken);
}

TEST(VelocityEstimator, LetsOneSensorWithABrokenClockNotTakeItAlong) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  SimulatedDrive drive(params.car, HardLap);
  VelocityEstimator estimator(params);
  const auto ahead = [](double, Readings& readings) { readings.ground_speed->utime += 5'000'000; };
  Drive(drive, estimator, 0.1);
  const auto samples = Drive(drive, estimator, 10.0, ahead);
  EXPECT_EQ(samples.back().estimate.states.ground_speed, SensorState::kSilent);
  EXPECT_LE(ErrorsOf(samples, 0.5, 10.0).vx_max, 0.2);
}

TEST(VelocityEstimator, StartsAnewAfterAGapOfEverything) {
  const VelocityEstimatorParams params = ShippedParams().estimator;
  SimulatedDrive drive(params.car, HardLap);
  VelocityEstimator estimator(params);
  Drive(drive, estimator, 3.0);
  for (int tick = 0; tick < 200; ++tick) drive.Step();
  int refused = 0;
  bool advanced = false;
  for (int tick = 0; tick < 10 && !advanced; ++tick) {
    drive.Step();
    const Readings readings = drive.Measure();
    for (const Intake intake :
         {estimator.Add(*readings.motors), estimator.Add(*readings.ground_speed)}) {
      refused += intake == Intake::kTooFarAhead ? 1 : 0;
    }
    if (estimator.Add(*readings.imu) != Intake::kTaken) continue;
    EXPECT_TRUE(estimator.Advance(readings.imu->utime).valid);
    advanced = true;
  }
  EXPECT_TRUE(advanced);
  EXPECT_GT(refused, 0);
  EXPECT_LE(ErrorsOf(Drive(drive, estimator, 3.0), 0.0, 100.0).vx_max, 0.2);
}

TEST(VelocityEstimator, ComparesALateReadingWithTheStateOfItsOwnTime) {
  // GNSS alone tells the velocity while the car brakes at 8 m/s^2: 80 ms of lag would be an error
  // of 0.64 m/s.
  const VelocityEstimatorParams params = ShippedParams().estimator;
  SimulatedDrive drive(params.car, [](double t) { return DriveDemand{t < 2.0 ? 7.0 : -4.0, 0.0}; });
  VelocityEstimator estimator(params);
  std::vector<Readings> history;
  std::vector<DriveSample> samples;
  for (int tick = 0; tick < 400; ++tick) {
    const DriveTruth truth = drive.Step();
    history.push_back(drive.Measure());
    estimator.Add(*history.back().imu);
    if (tick >= 8 && history[static_cast<size_t>(tick - 8)].gnss)
      estimator.Add(*history[static_cast<size_t>(tick - 8)].gnss);
    samples.push_back({truth, estimator.Advance(history.back().imu->utime)});
  }
  EXPECT_LE(ErrorsOf(samples, 1.0, 4.0).vx_rms, 0.05);
}

}  // namespace
}  // namespace hairpin
