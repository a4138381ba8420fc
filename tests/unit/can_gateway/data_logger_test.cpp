// The rules' frames 0x500 to 0x502, as python3-canmatrix reads them.
#include "daemons/can_gateway/data_logger.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <sstream>
#include <string>

#include "hairpin/as_state_t.hpp"
#include "hairpin/vehicle_t.hpp"

namespace hairpin {
namespace {

using Values = std::map<std::string, double>;

// What the oracle reads in the three frames; the signals' names are different in all of them.
Values Read(const LoggerInput& input) {
  std::ostringstream command;
  command << "/usr/bin/python3 " << HAIRPIN_SOURCE_DIR << "/tests/unit/can/dbc_oracle.py "
          << HAIRPIN_SOURCE_DIR << "/config/hairpin.dbc decode" << std::hex;
  for (const CanFrame& frame : DataLoggerFrames(input)) {
    command << ' ' << frame.id << '=';
    for (size_t i = 0; i < frame.length; ++i) {
      char byte[3];
      std::snprintf(byte, sizeof byte, "%02x", unsigned{frame.data[i]});
      command << byte;
    }
  }
  FILE* oracle = popen(command.str().c_str(), "r");
  if (oracle == nullptr) return {};
  Values values;
  char line[1024];
  while (std::fgets(line, sizeof line, oracle) != nullptr) {
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      const size_t equals = word.find('=');
      if (equals != std::string::npos)
        values[word.substr(0, equals)] = std::stod(word.substr(equals + 1));
    }
  }
  EXPECT_EQ(pclose(oracle), 0);
  return values;
}

LoggerInput Lap() {
  LoggerInput input;
  input.imu.acceleration = {-7.25, 11.5, 9.0};
  input.imu.angular_rate = {0.0, 0.0, 1.5};
  input.motors.torque = {-28.0, -28.0, -56.0, -56.0};
  input.steering.angle = -0.21;
  input.brake.level = 0.42;
  input.vehicle.speed = 11.4;
  input.vehicle.mission = vehicle_t::MISSION_TRACKDRIVE;
  input.vehicle.ebs_state = vehicle_t::EBS_ARMED;
  input.vehicle.brakes_ok = true;
  input.order = {-0.25, {-70.0, -70.0, -70.0, -70.0}, 0.5};
  input.target_speed = 8.0;
  input.as.state = as_state_t::STATE_DRIVING;
  input.as.lap = 7;
  input.steering_on = true;
  input.cones = 31;
  input.cones_all = 40'000;
  input.max_wheel_torque = 280.0;
  return input;
}

TEST(DataLogger, TellsWhatTheCarDoesAndWhatItIsToDo) {
  Values values = Read(Lap());
  EXPECT_EQ(values.at("SpeedActual"), 41.0);
  EXPECT_EQ(values.at("SpeedTarget"), 29.0);
  EXPECT_EQ(values.at("SteeringActual"), -12.0);
  EXPECT_EQ(values.at("SteeringTarget"), -14.5);
  EXPECT_EQ(values.at("BrakeActual"), 42.0);
  EXPECT_EQ(values.at("BrakeTarget"), 50.0);
  EXPECT_EQ(values.at("MotorMomentActual"), -15.0);
  EXPECT_EQ(values.at("MotorMomentTarget"), -25.0);
  EXPECT_EQ(values.at("AccelerationLongitudinal"), -7.25);
  EXPECT_EQ(values.at("AccelerationLateral"), 11.5);
  EXPECT_NEAR(values.at("YawRate"), 85.944, 1.0 / 256.0);
  EXPECT_EQ(values.at("AsStatus"), 3.0);
  EXPECT_EQ(values.at("EbsState"), 2.0);
  EXPECT_EQ(values.at("Mission"), 3.0);
  EXPECT_EQ(values.at("SteeringState"), 1.0);
  EXPECT_EQ(values.at("ServiceBrakeState"), 3.0);
  EXPECT_EQ(values.at("LapCounter"), 7.0);
  EXPECT_EQ(values.at("ConesCount"), 31.0);
  EXPECT_EQ(values.at("ConesCountAll"), 40'000.0);
}

TEST(DataLogger, HoldsWhatIsBeyondItsScalesAtTheirEnds) {
  LoggerInput input = Lap();
  input.vehicle.speed = 100.0;
  input.steering.angle = 2.0;
  input.imu.acceleration = {-100.0, 100.0, 0.0};
  input.imu.angular_rate = {0.0, 0.0, -9.0};
  input.order.wheel_torque.fill(1e6);
  input.as.lap = 20;
  input.cones = 1'000;
  input.cones_all = 1'000'000;
  Values values = Read(input);
  EXPECT_EQ(values.at("SpeedActual"), 255.0);
  EXPECT_EQ(values.at("SteeringActual"), 63.5);
  EXPECT_EQ(values.at("MotorMomentTarget"), 100.0);
  EXPECT_EQ(values.at("AccelerationLongitudinal"), -64.0);
  EXPECT_NEAR(values.at("AccelerationLateral"), 64.0, 1.0 / 512.0);
  EXPECT_EQ(values.at("YawRate"), -256.0);
  EXPECT_EQ(values.at("LapCounter"), 15.0);
  EXPECT_EQ(values.at("ConesCount"), 255.0);
  EXPECT_EQ(values.at("ConesCountAll"), 131'071.0);
}

TEST(DataLogger, KnowsNoManualDriving) {
  LoggerInput input = Lap();
  input.as.state = as_state_t::STATE_MANUAL;
  input.vehicle.mission = vehicle_t::MISSION_MANUAL;
  input.vehicle.ebs_state = vehicle_t::EBS_UNAVAILABLE;
  input.vehicle.brakes_ok = false;
  Values values = Read(input);
  EXPECT_EQ(values.at("AsStatus"), 1.0);
  EXPECT_EQ(values.at("EbsState"), 1.0);
  EXPECT_EQ(values.at("Mission"), 0.0);
  EXPECT_EQ(values.at("ServiceBrakeState"), 1.0);
}

}  // namespace
}  // namespace hairpin
