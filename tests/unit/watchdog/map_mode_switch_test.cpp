#include "daemons/watchdog/map_mode_switch.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace hairpin {
namespace {

constexpr PipelineFlags kNothing{false, false, false};
constexpr PipelineFlags kFusionOnly{true, false, false};
constexpr PipelineFlags kAll{true, true, true};
constexpr PipelineFlags kLidarCamera{false, true, true};
constexpr PipelineFlags kLidar{false, true, false};
constexpr PipelineFlags kCamera{false, false, true};

class MapModes : public testing::Test {
 protected:
  MapMode At(double seconds, const PipelineFlags& fresh, const PipelineFlags& healthy) {
    modes_.Update(1'000'000'000 + static_cast<int64_t>(seconds * 1e6), fresh, healthy);
    return modes_.mode();
  }
  MapMode At(double seconds, const PipelineFlags& fresh) { return At(seconds, fresh, fresh); }

  MapModeSwitch modes_{{3, 10.0, 1.0}};
};

TEST(DecideMapMode, IsThisTruthTable) {
  struct Row {
    bool fusion, lidar, camera;
    MapMode mode;
  };
  constexpr Row kTable[] = {
      {false, false, false, MapMode::kNone},     {false, false, true, MapMode::kCameraOnly},
      {false, true, false, MapMode::kLidarOnly}, {false, true, true, MapMode::kLidarAndCamera},
      {true, false, false, MapMode::kFusion},    {true, false, true, MapMode::kFusion},
      {true, true, false, MapMode::kFusion},     {true, true, true, MapMode::kFusion},
  };
  for (const Row& row : kTable) {
    EXPECT_EQ(DecideMapMode(row.fusion, row.lidar, row.camera), row.mode)
        << row.fusion << row.lidar << row.camera;
  }
}

TEST_F(MapModes, StartWithNoneAndRiseOnlyToWhatIsHealthy) {
  EXPECT_EQ(modes_.mode(), MapMode::kNone);
  EXPECT_EQ(At(0.0, kAll, kNothing), MapMode::kNone);
  EXPECT_EQ(At(1.0, kAll, kLidar), MapMode::kLidarOnly);
  EXPECT_EQ(At(1.1, kAll, kAll), MapMode::kFusion);
}

TEST_F(MapModes, FallAtOnceToTheBestThatIsFreshWithoutAProofOfHealth) {
  At(0.0, kAll);
  EXPECT_EQ(At(0.1, kLidarCamera, kNothing), MapMode::kLidarAndCamera);
  EXPECT_EQ(At(0.2, kCamera, kNothing), MapMode::kCameraOnly);
  EXPECT_EQ(At(0.3, kLidar, kNothing), MapMode::kLidarOnly);
  EXPECT_EQ(At(0.4, kNothing), MapMode::kNone);
}

TEST_F(MapModes, StayInFusionWhileOnlyAnUnusedPipelineDies) {
  At(0.0, kAll);
  EXPECT_EQ(At(0.1, kFusionOnly), MapMode::kFusion);
}

TEST_F(MapModes, DoNotRiseFromOneSingleSensorToTheOther) {
  At(0.0, kCamera);
  EXPECT_EQ(At(0.5, kLidarCamera, kLidar), MapMode::kLidarAndCamera)
      << "the camera in use needs no probation";
  At(1.0, kCamera);
  EXPECT_EQ(At(1.5, kLidarCamera, kCamera), MapMode::kCameraOnly);
}

class Flapping : public MapModes {
 protected:
  // Falls from FUSION to LIDAR_AND_CAMERA, and rises again 1.5 s later.
  void Flap(double seconds) {
    At(seconds, kLidarCamera);
    At(seconds + 1.5, kAll);
  }
  void SetUp() override { At(0.0, kAll); }
};

TEST_F(Flapping, ThreeTimesInTenSecondsIsForgiven) {
  for (const double start : {1.0, 3.0, 5.0}) Flap(start);
  EXPECT_FALSE(modes_.latched());
  EXPECT_EQ(modes_.mode(), MapMode::kFusion);
}

TEST_F(Flapping, AFourthTimeWithinTenSecondsLatchesTheLowerMode) {
  for (const double start : {1.0, 3.0, 5.0, 11.0}) Flap(start);
  EXPECT_TRUE(modes_.latched());
  EXPECT_EQ(modes_.mode(), MapMode::kLidarAndCamera);
  EXPECT_EQ(At(1000.0, kAll), MapMode::kLidarAndCamera) << "until the watchdog is restarted";
}

TEST_F(Flapping, AFourthTimeAfterTheWindowIsForgiven) {
  for (const double start : {1.0, 3.0, 5.0, 11.01}) Flap(start);
  EXPECT_FALSE(modes_.latched());
  EXPECT_EQ(modes_.mode(), MapMode::kFusion);
}

TEST_F(Flapping, OneFallInStepsIsOneFlap) {
  for (const double start : {1.0, 4.0, 7.0}) {
    At(start, kLidarCamera);
    At(start + 0.01, kLidar);
    At(start + 0.02, kNothing);
    EXPECT_EQ(At(start + 1.5, kAll), MapMode::kFusion);
  }
  EXPECT_FALSE(modes_.latched());
}

TEST_F(Flapping, AFallMadeGoodWithinTheTimeOfHealthIsNoFlap) {
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(At(1.0 + 0.2 * i, kLidarCamera), MapMode::kLidarAndCamera);
    EXPECT_EQ(At(1.05 + 0.2 * i, kAll), MapMode::kFusion);
  }
  EXPECT_FALSE(modes_.latched());
}

TEST_F(Flapping, ToAndFroBetweenSingleSensorsCountsEachTime) {
  At(1.0, kLidar);
  At(2.0, kCamera);
  At(3.0, kLidar);
  EXPECT_FALSE(modes_.latched());
  At(4.0, kCamera);
  EXPECT_FALSE(modes_.latched()) << "the first fall from FUSION went on as the second";
  At(5.0, kLidar);
  EXPECT_TRUE(modes_.latched());
}

TEST_F(Flapping, WhenLatchedMayFallOrGoSidewaysButNeverRise) {
  for (const double start : {1.0, 3.0, 5.0, 7.0}) Flap(start);
  ASSERT_TRUE(modes_.latched());
  EXPECT_EQ(At(10.0, {true, false, true}), MapMode::kCameraOnly) << "not the FUSION that flapped";
  EXPECT_EQ(At(11.0, kAll), MapMode::kCameraOnly);
  EXPECT_EQ(At(12.0, {true, true, false}), MapMode::kLidarOnly);
  EXPECT_EQ(At(13.0, kNothing), MapMode::kNone);
  EXPECT_EQ(At(14.0, kAll), MapMode::kNone);
}

TEST(MapModeSwitch, RefusesParametersOutOfBounds) {
  EXPECT_THROW(MapModeSwitch({-1, 10.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(MapModeSwitch({3, 0.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(MapModeSwitch({3, 10.0, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
