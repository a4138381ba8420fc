#include <gtest/gtest.h>

#include "daemons/global_mapper/map_file.hpp"
#include "daemons/global_mapper/race_line/corridor.hpp"
#include "tests/support/race_run.hpp"
#include "tools/report/map_comparison.hpp"

namespace hairpin {
namespace {

constexpr double kMaxRmse12 = 0.29;  // m, at 12 m/s: the paper's, Table II
constexpr double kMinMapped = 0.99;

void ExpectGoodMap(const RunLog& log) {
  ASSERT_FALSE(log.global_maps.empty());
  EXPECT_EQ(log.global_maps.back().phase, global_map_t::PHASE_LOOP_CLOSED);
  const auto map = CompareGlobalMap(log);
  ASSERT_TRUE(map);
  EXPECT_LE(map->rmse.value_or(1.0), kMaxRmse12);
  EXPECT_EQ(map->doubled, 0);
  EXPECT_GE(map->matched, kMinMapped * (map->matched + map->missed));
}

TEST(GlobalMap, OfALapAt12MetresPerSecondIsAsGoodAsThePapers) {
  ExpectGoodMap(RunInProcess(DefaultTrackFile(), 3).log);
}

TEST(GlobalMap, ClosesItsLoopWithTheBiasesOfTheMotionSensorsDoubled) {
  const std::string sensors = "simulator.motion_sensors.";
  ExpectGoodMap(
      RunInProcess(
          DefaultTrackFile(), 1, {},
          {sensors + "imu.gyro_bias_degps=0.04", sensors + "imu.gyro_scale=0.004",
           sensors + "imu.accelerometer_bias_mps2=0.04", sensors + "imu.accelerometer_scale=0.004",
           sensors + "wheels.torque_scale=0.04", sensors + "steering.offset_deg=0.2",
           sensors + "ground_speed.scale=0.006", sensors + "ground_speed.misalignment_deg=0.2",
           sensors + "gnss.position_bias_m=0.8"})
          .log);
}

// FSS19 passes its start at 30 m, the other way round, when half of it is driven: the loop closes
// there, the lap does not end.
TEST(GlobalMap, OfATrackThatPassesItsOwnStartIsWholeAndLeadsBackToIt) {
  const std::string track = DataFolder() / "tracks/FSS19.yaml";
  if (!std::filesystem::exists(track)) GTEST_SKIP() << "no " << track;
  const TemporaryFolder folder;
  const RaceRun run =
      RunInProcess(track, 1, {}, {"global_mapper.files.directory=" + folder.path()});
  ExpectGoodMap(run.log);
  const MapFile map = LoadMapFile(folder.File("map.yaml"));
  EXPECT_EQ(map.laps, 1);
  EXPECT_EQ(map.cones.size(), run.log.truth_track->cones.size());
  EXPECT_NO_THROW(LapOf(map.driven, 50.0));
}

}  // namespace
}  // namespace hairpin
