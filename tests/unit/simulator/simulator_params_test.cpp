#include "tools/simulator/simulator_params.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hairpin {
namespace {

// The problems that are reported with `overrides` in place of the shipped values.
std::string Problems(const std::vector<std::string>& overrides) {
  try {
    const std::string directory = std::string(HAIRPIN_SOURCE_DIR) + "/config";
    LoadSimulatorParams(Config::Load(directory, "simulator", overrides));
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

TEST(SimulatorParams, AcceptsTheShippedFile) { EXPECT_EQ(Problems({}), ""); }

TEST(SimulatorParams, ReadsDegreesIntoRadians) {
  const Config config = Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "simulator",
                                     {"cone_sensors.camera.half_field_of_view_deg=90"});
  EXPECT_NEAR(LoadSimulatorParams(config).camera.half_field_of_view_rad, 1.5707963, 1e-6);
}

TEST(SimulatorParams, NamesEveryValueOutOfRange) {
  const std::string problems = Problems({"vehicle.wheel_inertia_kgm2=-1", "referee.laps=0"});
  EXPECT_THAT(problems, testing::HasSubstr("vehicle.wheel_inertia_kgm2"));
  EXPECT_THAT(problems, testing::HasSubstr("referee.laps"));
}

TEST(SimulatorParams, WantsADeadmanWhoseStepsFollowEachOther) {
  EXPECT_THAT(Problems({"actuators.brake_after_s=0.04"}),
              testing::HasSubstr("actuators.brake_after_s"));
}

TEST(SimulatorParams, KnowsTheReceiversSolutionsByName) {
  const Config config = Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "simulator",
                                     {"motion_sensors.gnss.fix=rtk"});
  EXPECT_EQ(LoadSimulatorParams(config).motion_sensors.gnss_fix, int32_t{gnss_t::FIX_RTK});
  EXPECT_THAT(Problems({"motion_sensors.gnss.fix=fixed"}),
              testing::HasSubstr("motion_sensors.gnss.fix: `fixed`"));
}

TEST(SimulatorParams, WantsTablesOfOneLengthAndRisingRanges) {
  EXPECT_THAT(Problems({"cone_sensors.lidar.recall=[0.9, 0.5]"}),
              testing::HasSubstr("cone_sensors.lidar.recall"));
  EXPECT_THAT(Problems({"cone_sensors.lidar.noise_ranges_m=[5.0, 5.0]"}),
              testing::HasSubstr("rising"));
}

}  // namespace
}  // namespace hairpin
