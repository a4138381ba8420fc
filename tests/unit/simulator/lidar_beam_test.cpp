#include <gtest/gtest.h>

#include "tests/support/simulator_setup.hpp"
#include "tools/simulator/lidar/hash_random.hpp"

namespace hairpin {
namespace {

BeamParams Noiseless() {
  BeamParams params = ShippedSimulatorParams().lidars.sensor.beam;
  params.range_noise_m = 0.0;
  params.reflectivity_noise = 0.0;
  params.loss = 0.0;
  return params;
}

BeamTargets Wall(float range, float echo) {
  BeamTargets targets;
  targets.fill({range, echo, -1});
  return targets;
}

LidarReturn Return(const BeamTargets& targets, uint64_t index = 0) {
  HashRandom random(1, index);
  return StrongestReturn(Noiseless(), targets, 0.0, random);
}

double ShareSeen(const BeamTargets& targets) {
  int seen = 0;
  for (uint64_t i = 0; i < 2000; ++i) seen += Return(targets, i).range > 0.0f;
  return seen / 2000.0;
}

TEST(LidarBeam, SharesItsLightAmongItsRays) {
  float sum = 0.0f;
  for (size_t ray = 0; ray < kRaysPerBeam; ++ray) sum += RayShare(ray);
  EXPECT_NEAR(sum, 1.0f, 1e-6f);
}

TEST(LidarBeam, ReportsRangeAndReflectivityOfAWall) {
  const LidarReturn echo = Return(Wall(12.5f, 0.6f));
  EXPECT_NEAR(echo.range, 12.5f, 1e-4f);
  EXPECT_NEAR(echo.reflectivity, 0.6f, 1e-5f);
}

TEST(LidarBeam, OverAnEdgeGivesAPointBetween) {
  BeamTargets targets = Wall(10.0f, 0.5f);
  for (size_t ray = 0; ray < 4; ++ray) targets[ray].range = 10.2f;
  const LidarReturn echo = Return(targets);
  EXPECT_GT(echo.range, 10.05f);
  EXPECT_LT(echo.range, 10.15f);
}

TEST(LidarBeam, ReportsTheStrongestOfTwoEchoesNotTheNearest) {
  BeamTargets targets = Wall(10.0f, 0.5f);
  targets[7] = {6.0f, 0.1f, 3};
  EXPECT_NEAR(Return(targets).range, 10.0f, 1e-4f);
  EXPECT_EQ(Return(targets).cone, -1);
}

TEST(LidarBeam, SaysWhichConeGaveMostOfTheEcho) {
  BeamTargets targets = Wall(10.0f, 0.5f);
  targets[0].cone = 4;
  EXPECT_EQ(Return(targets).cone, 4);
}

TEST(LidarBeam, LosesWhatIsTooDarkForItsRange) {
  const BeamParams params = Noiseless();
  const auto reference = static_cast<float>(params.reference_reflectivity);
  const auto range = static_cast<float>(params.reference_range_m);
  EXPECT_EQ(ShareSeen(Wall(range, 4.0f * reference)), 1.0);
  EXPECT_NEAR(ShareSeen(Wall(range, reference)), 0.5, 0.05);
  EXPECT_EQ(ShareSeen(Wall(range, 0.25f * reference)), 0.0);
  EXPECT_EQ(ShareSeen(BeamTargets{}), 0.0);
}

TEST(LidarBeam, WritesDiffuseTargetsAsPercentAndReflectorsAbove) {
  EXPECT_EQ(ReflectivityByte(0.0f), 0);
  EXPECT_EQ(ReflectivityByte(0.37f), 37);
  EXPECT_EQ(ReflectivityByte(1.0f), 100);
  EXPECT_EQ(ReflectivityByte(10.0f), 178);
  EXPECT_EQ(ReflectivityByte(1e6f), 255);
}

}  // namespace
}  // namespace hairpin
