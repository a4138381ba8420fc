#include "tools/evaluation/velocity_evaluation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/clock.hpp"
#include "daemons/velocity_estimator/velocity_estimator_node.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hairpin {
namespace {

constexpr int64_t kStart = 1'700'000'000'000'000;

VelocityEstimatorParams Params() {
  return LoadVelocityEstimatorParams(
             Config::Load(HAIRPIN_SOURCE_DIR "/config/cars/amz2017", "velocity_estimator"))
      .estimator;
}

std::string RealRun() {
  const char* folder = std::getenv("HAIRPIN_DATA");
  return (folder ? std::string(folder) : std::string(HAIRPIN_SOURCE_DIR "/../shared/data")) +
         "/runs/amz2017";
}

/// Three seconds of standing, then a circle of 12.5 m at 5 m/s, of exact sensors; the optical one
/// at its mount.
SensorRecording Circle(const Car& car) {
  SensorRecording recording;
  double speed = 0.0, yaw = 0.0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  for (int i = 0; i < 4000; ++i) {
    const double t = i * 0.005;
    const int64_t utime = kStart + i * 5000;
    const double acceleration = t > 3.0 && speed < 5.0 ? 2.0 : 0.0;
    const double yaw_rate = speed / 12.5;
    const Eigen::Vector2d p = car.ground_speed_position;
    recording.imu.push_back({utime, {acceleration, yaw_rate * speed}, yaw_rate});
    recording.ground_speed.push_back(
        {utime, {speed - yaw_rate * p.y() + 1e-4 * (i % 2), yaw_rate * p.x()}});
    if (i % 2 == 0) {
      MotorsReading motors{utime, {}, std::nullopt};
      const auto wheels = car.wheel_positions();
      for (size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d hub(speed - yaw_rate * wheels[k].y(), yaw_rate * wheels[k].x());
        motors.speed[k] = (k < 2 ? hub.norm() : hub.x()) / car.wheel_radius + 1e-4 * (i % 4);
      }
      recording.motors.push_back(motors);
    }
    if (i % 20 == 0) recording.gps.push_back({utime, position});
    position += 0.005 * speed * Eigen::Vector2d(std::cos(yaw + 1.0), std::sin(yaw + 1.0));
    yaw += 0.005 * yaw_rate;
    speed += 0.005 * acceleration;
  }
  return recording;
}

TEST(VelocityEvaluation, FindsThePositionOfACircleWhateverItsHeadingInTheWorld) {
  const VelocityEstimatorParams params = Params();
  const SensorRecording recording = Circle(params.car);
  const Drive drive = DriveOf(recording, params.car.wheel_radius);
  EXPECT_NEAR(SecondsBetween(kStart, drive.from), 3.5, 0.1) << "1 m/s";
  const auto comparison =
      ComparePosition(RunEstimator(recording, params), recording, drive, params.car);
  ASSERT_TRUE(comparison);
  EXPECT_LT(comparison->rms_m, 0.15);
}

TEST(SensorFaults, ChangeTheirSensorOnlyAndOnlyFromTheirTimeOn) {
  const SensorRecording sound = Circle(Params().car);
  const int64_t from = kStart + 10'000'000;
  const SensorRecording removed =
      WithFault(sound, FaultySensor::kOptical, FaultKind::kRemoved, from);
  EXPECT_EQ(removed.ground_speed.back().utime, from - 5000);
  EXPECT_EQ(removed.imu.size(), sound.imu.size());
  const SensorRecording scaled =
      WithFault(sound, FaultySensor::kOneWheel, FaultKind::kScaled, from);
  EXPECT_DOUBLE_EQ(scaled.motors.back().speed[2], 1.3 * sound.motors.back().speed[2]);
  EXPECT_EQ(scaled.motors.back().speed[3], sound.motors.back().speed[3]);
  EXPECT_EQ(scaled.motors[999].speed, sound.motors[999].speed);
  const SensorRecording frozen = WithFault(sound, FaultySensor::kGyro, FaultKind::kFrozen, from);
  EXPECT_EQ(frozen.imu.back().yaw_rate, sound.imu[1999].yaw_rate);
  EXPECT_EQ(frozen.imu.back().utime, sound.imu.back().utime);
  const SensorRecording spiking =
      WithFault(sound, FaultySensor::kWheels, FaultKind::kSpiking, from);
  int spikes = 0;
  for (size_t i = 0; i < sound.motors.size(); ++i)
    spikes += spiking.motors[i].speed != sound.motors[i].speed ? 1 : 0;
  EXPECT_NEAR(spikes, 100, 30);
}

TEST(SensorRecording, NamesTheLineThatCannotBeRead) {
  const TemporaryFolder folder;
  std::ofstream(folder.File("imu_200hz.csv"))
      << "t_s,wx,wy,wz,ax,ay,az\n1,2,3,4,5,6,7\n2,x,3,4,5,6,7\n";
  try {
    LoadSensorRecording(folder.path(), {621.0, 0.231});
    ADD_FAILURE() << "was read";
  } catch (const RecordingError& error) {
    EXPECT_NE(std::string(error.what()).find("imu_200hz.csv:3: 'x'"), std::string::npos);
  }
}

TEST(VelocityEvaluation, BearsEveryFaultOnAMZsDriveAndKeepsThePosition) {
  if (!std::filesystem::exists(RealRun())) GTEST_SKIP() << RealRun() << " is absent";
  const VelocityEstimatorParams params = Params();
  const SensorRecording recording =
      LoadSensorRecording(RealRun(), {621.0, params.car.wheel_radius});
  const nlohmann::json figures = ToJson(EvaluateVelocity(recording, params), params);
  EXPECT_LE(figures["position_rms_m"].get<double>(), 0.9);
  EXPECT_LE(figures["without"]["optical"]["position_rms_m"].get<double>(), 1.1);
  EXPECT_TRUE(figures["faults_borne"].get<bool>()) << figures["faults"].dump(1);
  EXPECT_GE(figures["nis_inside_percent"].get<double>(), 85.0);
}

}  // namespace
}  // namespace hairpin
