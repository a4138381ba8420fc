#include <gmock/gmock.h>

#include "tests/support/lidar_world.hpp"
#include "tests/unit/lidar_cone_detector/shipped_params.hpp"

namespace hairpin {
namespace {

using testing::Not;
using testing::SizeIs;

const Eigen::Vector3f kNose(1.25f, 0.0f, 0.35f);

LidarWorld Lane() {
  LidarWorld world;
  for (int i = 0; i < 10; ++i)
    world.cones.push_back({{3.0f + 2.5f * static_cast<float>(i / 2), i % 2 == 0 ? 1.6f : -1.7f}});
  return world;
}

void ExpectEveryCone(const LidarWorld& world, const std::vector<DetectedCone>& found,
                     float tolerance) {
  ASSERT_THAT(found, SizeIs(world.cones.size()));
  for (const LidarWorld::Cone& cone : world.cones) {
    float nearest = 100.0f;
    for (const DetectedCone& detected : found)
      nearest = std::min(nearest, (detected.position - cone.position).norm());
    EXPECT_LT(nearest, tolerance) << cone.position.transpose();
  }
}

TEST(LidarConeDetector, FindsTheConesOfALaneAndNothingElse) {
  const SensorGeometry sensor = UnevenSensor(kNose, 0.2f);
  LidarConeDetector detector(ShippedParams().detector);
  const LidarWorld world = Lane();
  const LabelledCloud scan = Scan(world, sensor, 0.02f, 60.0f, 1);
  ExpectEveryCone(world, detector.Detect(scan.cloud, std::vector{sensor}), 0.05f);
}

TEST(LidarConeDetector, DoesNotMindABodyThatRollsAndPitches) {
  const SensorGeometry sensor = UnevenSensor(kNose, 0.2f);
  LidarConeDetector detector(ShippedParams().detector);
  LidarWorld world = Lane();
  world.ground = 0.05f;
  world.slope_x = 0.02f;
  world.slope_y = -0.035f;
  const LabelledCloud scan = Scan(world, sensor, 0.02f, 60.0f, 2);
  ExpectEveryCone(world, detector.Detect(scan.cloud, std::vector{sensor}), 0.05f);
  EXPECT_NEAR(detector.ground().plane().slope_y, -0.035f, 0.004f);
  EXPECT_NEAR(detector.ground().HeightAt(8.0f, 2.0f), world.GroundAt(8.0f, 2.0f), 0.03f);
}

TEST(LidarConeDetector, TakesWallsForNoCones) {
  const SensorGeometry sensor = UnevenSensor(kNose, 0.2f);
  LidarConeDetector detector(ShippedParams().detector);
  LidarWorld world = LaneBetweenWalls(8);
  const LabelledCloud scan = Scan(world, sensor, 0.02f, 60.0f, 3);
  ExpectEveryCone(world, detector.Detect(scan.cloud, std::vector{sensor}), 0.05f);
}

TEST(LidarConeDetector, TakesPostsForNoCones) {
  const SensorGeometry sensor = UnevenSensor(kNose, 0.2f);
  LidarConeDetector detector(ShippedParams().detector);
  LidarWorld world = Lane();
  const LidarWorld lane = world;
  world.cones.push_back({{6.0f, 4.0f}, {1.8, 0.03, 0.03}});    // of a sign
  world.cones.push_back({{7.0f, -4.5f}, {0.85, 0.09, 0.07}});  // a leg
  world.cones.push_back({{12.0f, 5.0f}, {0.65, 0.12, 0.12}});  // a bollard
  const LabelledCloud scan = Scan(world, sensor, 0.02f, 60.0f, 3);
  ExpectEveryCone(lane, detector.Detect(scan.cloud, std::vector{sensor}), 0.05f);
}

// Seen along the row, each stack shows as a strip beside the one before it, no wider than a cone.
TEST(LidarConeDetector, TakesARowOfStackedTyresForNoCones) {
  const SensorGeometry sensor = UnevenSensor(kNose, 0.2f);
  LidarWorld world;
  for (int i = 0; i < 5; ++i) {
    const auto along = static_cast<float>(i);
    world.cones.push_back({{8.0f + 0.6f * along, 1.5f + 0.25f * along}, {0.38, 0.3, 0.3}});
  }
  const LabelledCloud scan = Scan(world, sensor, 0.015f, 60.0f, 1);
  LidarConeDetectorParams params = ShippedParams().detector;
  LidarConeDetector detector(params);
  EXPECT_THAT(detector.Detect(scan.cloud, std::vector{sensor}), SizeIs(0));
  params.surroundings.min_returns = 1'000'000;
  LidarConeDetector careless(params);
  EXPECT_THAT(careless.Detect(scan.cloud, std::vector{sensor}), Not(SizeIs(0)))
      << "nothing here looks like a cone, and the test shows nothing";
}

TEST(LidarConeDetector, TakesAConeCloseBeforeAWallForACone) {
  const SensorGeometry sensor = UnevenSensor(kNose, 0.2f);
  LidarConeDetector detector(ShippedParams().detector);
  LidarWorld world;
  world.cones.push_back({{8.0f, 1.0f}});
  world.walls.push_back({{8.5f, -3.0f}, {8.5f, 5.0f}, 1.0f});
  const LabelledCloud scan = Scan(world, sensor, 0.02f, 60.0f, 2);
  ExpectEveryCone(world, detector.Detect(scan.cloud, std::vector{sensor}), 0.05f);
}

TEST(LidarConeDetector, TakesTwoConesSideBySideForTwo) {
  const SensorGeometry sensor = UnevenSensor(kNose, 0.2f);
  LidarConeDetector detector(ShippedParams().detector);
  LidarWorld world;
  world.cones.push_back({{7.0f, 1.0f}});
  world.cones.push_back({{7.0f, 1.55f}});
  const LabelledCloud scan = Scan(world, sensor, 0.02f, 60.0f, 2);
  ExpectEveryCone(world, detector.Detect(scan.cloud, std::vector{sensor}), 0.05f);
}

TEST(LidarConeDetector, TellsALargeConeFromASmallOne) {
  const SensorGeometry sensor = UnevenSensor(kNose, 0.2f);
  LidarConeDetector detector(ShippedParams().detector);
  LidarWorld world;
  world.cones.push_back({{6.0f, 1.5f}, {0.505, 0.115, 0.03}});
  world.cones.push_back({{6.0f, -1.5f}});
  const LabelledCloud scan = Scan(world, sensor, 0.01f, 60.0f, 4);
  const std::vector<DetectedCone>& cones = detector.Detect(scan.cloud, std::vector{sensor});
  ASSERT_THAT(cones, SizeIs(2));
  for (const DetectedCone& cone : cones) EXPECT_EQ(cone.large, cone.position.y() > 0.0f);
}

TEST(LidarConeDetector, IsLessSureOfPositionFartherAway) {
  const SensorGeometry sensor = UnevenSensor(kNose, 0.2f);
  LidarConeDetector detector(ShippedParams().detector);
  const LabelledCloud scan = Scan(Lane(), sensor, 0.02f, 60.0f, 5);
  const std::vector<DetectedCone> cones = detector.Detect(scan.cloud, std::vector{sensor});
  ASSERT_GE(cones.size(), 2u);
  EXPECT_LT(cones.front().covariance.trace(), cones.back().covariance.trace());
  for (const DetectedCone& cone : cones) EXPECT_GT(cone.covariance.determinant(), 0.0f);
}

TEST(LidarConeDetector, SaysTheSameTwice) {
  const SensorGeometry sensor = UnevenSensor(kNose, 0.2f);
  LidarConeDetector used(ShippedParams().detector), fresh(ShippedParams().detector);
  const LabelledCloud other = Scan(LaneBetweenWalls(12), sensor, 0.02f, 60.0f, 6);
  const LabelledCloud scan = Scan(Lane(), sensor, 0.02f, 60.0f, 7);
  used.Detect(other.cloud, std::vector{sensor});
  const std::vector<DetectedCone> a = used.Detect(scan.cloud, std::vector{sensor});
  const std::vector<DetectedCone> b = fresh.Detect(scan.cloud, std::vector{sensor});
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].points, b[i].points);
  }
}

TEST(LidarConeDetector, HasNothingToSayOfAnEmptyCloud) {
  LidarConeDetector detector(ShippedParams().detector);
  EXPECT_THAT(detector.Detect(PointCloud{}, std::vector{UnevenSensor(kNose, 0.2f)}), SizeIs(0));
}

}  // namespace
}  // namespace hairpin
