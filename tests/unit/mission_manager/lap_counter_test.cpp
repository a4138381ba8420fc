#include "daemons/mission_manager/lap_counter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "daemons/mission_manager/mission_manager_node.hpp"

namespace hairpin {
namespace {

constexpr double kPi = std::numbers::pi;

MissionManagerParams ShippedMissions() {
  return LoadMissionManagerParams(
      Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "mission_manager"));
}

LapCounterParams ShippedParams() { return ShippedMissions().laps; }

// A car that drives in a straight line or a circle, with its dead reckoning and its view of the
// cones. True frame: the start pose is the origin, the gate 6 m ahead.
class Drive {
 public:
  explicit Drive(const LapCounterParams& params = ShippedParams()) : counter(params) {}

  /// Every metre of dead reckoning turns by `yaw_drift` [rad] and stretches by `scale`.
  void Go(double length, double curvature) {
    constexpr double kStep = 0.1;
    for (int i = 0; i < static_cast<int>(std::lround(length / kStep)); ++i) {
      truth = truth * Integrate({kStep, 0.0, kStep * curvature}, 1.0);
      own = own * Integrate({kStep * scale, 0.0, kStep * (curvature + yaw_drift)}, 1.0);
      distance += kStep;
      if (orange && i % 10 == 0) Look();
      counter.Move(own, distance);
    }
  }
  void Look() {
    std::vector<GateCone> seen;
    const Pose2 T_own_map = own * truth.Inverse();
    for (GateCone cone : cones) {
      cone.position = T_own_map * cone.position;
      seen.push_back(cone);
    }
    counter.Observe(seen, own, distance);
  }
  /// A closed lap of 200 m: four straights and corners, back at the start pose.
  void Lap() {
    for (int i = 0; i < 4; ++i) {
      Go(34.0, 0.0);
      Go(16.0, kPi / 2.0 / 16.0);
    }
  }

  std::vector<GateCone> cones{
      {{5.7, 1.7}, 0.9}, {{6.3, 1.7}, 0.9}, {{5.7, -1.7}, 0.9}, {{6.3, -1.7}, 0.9}};
  bool orange = true;
  double yaw_drift = 0.0;
  double scale = 1.0;
  Pose2 truth;
  Pose2 own;
  double distance = 0.0;
  LapCounter counter;
};

TEST(LapCounter, StartsAtTheGateAndFinishesAtTheNextPass) {
  Drive drive;
  drive.Go(5.8, 0.0);
  EXPECT_FALSE(drive.counter.started());
  drive.Go(0.4, 0.0);
  EXPECT_TRUE(drive.counter.started());
  EXPECT_EQ(drive.counter.laps(), 0);
  drive.Go(27.8, 0.0);
  drive.Go(16.0, kPi / 32.0);
  for (int i = 0; i < 3; ++i) {
    drive.Go(34.0, 0.0);
    drive.Go(16.0, kPi / 32.0);
  }
  drive.Go(5.8, 0.0);
  EXPECT_EQ(drive.counter.laps(), 0);
  drive.Go(0.4, 0.0);
  EXPECT_EQ(drive.counter.laps(), 1);
  drive.Go(20.0, 0.0);
  EXPECT_EQ(drive.counter.laps(), 1);
}

TEST(LapCounter, FindsTheGateWithADriftOfThreeMetresAndThreeDegreesAfterALap) {
  for (const double sign : {1.0, -1.0}) {
    Drive drive;
    drive.yaw_drift = sign * 3.0 / 180.0 * kPi / 200.0;
    drive.scale = 1.0 + sign * 0.02;
    drive.Lap();
    EXPECT_GT((drive.own.position() - drive.truth.position()).norm(), 1.5);
    EXPECT_EQ(drive.counter.laps(), 0);
    drive.Go(5.8, 0.0);
    EXPECT_EQ(drive.counter.laps(), 0);
    drive.Go(0.4, 0.0);
    EXPECT_EQ(drive.counter.laps(), 1);
  }
}

TEST(LapCounter, NoticesTheCrossingWhileTheGatesEstimateMovesAboutUnderTheCar) {
  Drive drive;
  drive.Go(5.9, 0.0);
  for (GateCone& cone : drive.cones) cone.position.x() -= 0.3;  // now seen behind the car
  drive.Look();
  drive.Go(0.1, 0.0);
  EXPECT_TRUE(drive.counter.started());
  // Back and forth: still one passage.
  for (int i = 0; i < 5; ++i) {
    for (GateCone& cone : drive.cones) cone.position.x() += i % 2 == 0 ? 0.6 : -0.6;
    drive.Look();
    drive.Go(0.1, 0.0);
  }
  EXPECT_EQ(drive.counter.laps(), 0);
}

TEST(LapCounter, ColourBlindFinishesTheLapAfterTheTrueLineByDeadReckoning) {
  for (const double drift : {0.0, 3.0, -3.0}) {
    Drive drive;
    drive.orange = false;
    drive.yaw_drift = drift / 180.0 * kPi / 200.0;
    drive.scale = 1.0 + 0.005 * drift;
    drive.Go(7.0, 0.0);
    EXPECT_EQ(drive.counter.started(), drift >= 0.0 || drive.own.x >= 6.0);
    drive.Go(27.0, 0.0);
    drive.Go(16.0, kPi / 32.0);
    for (int i = 0; i < 3; ++i) {
      drive.Go(34.0, 0.0);
      drive.Go(16.0, kPi / 32.0);
    }
    drive.Go(6.0, 0.0);
    EXPECT_EQ(drive.counter.laps(), 0) << "the true line is not passed yet";
    drive.Go(14.0, 0.0);
    EXPECT_EQ(drive.counter.laps(), 1) << drift;
  }
}

TEST(LapCounter, ColourBlindSinceTheStartUsesTheGateSeenAtTheStart) {
  Drive drive;
  drive.cones = {{{8.7, 1.7}, 0.9}, {{9.3, 1.7}, 0.9}, {{8.7, -1.7}, 0.9}, {{9.3, -1.7}, 0.9}};
  drive.Go(34.0, 0.0);
  EXPECT_TRUE(drive.counter.started());
  drive.orange = false;
  drive.Go(16.0, kPi / 32.0);
  for (int i = 0; i < 3; ++i) {
    drive.Go(34.0, 0.0);
    drive.Go(16.0, kPi / 32.0);
  }
  drive.Go(9.0 + 7.8, 0.0);
  EXPECT_EQ(drive.counter.laps(), 0);
  drive.Go(0.4, 0.0);
  EXPECT_EQ(drive.counter.laps(), 1);
}

// Lap of 400 m that passes the gate's stretch at `offset` metres beside it, against the driving
// direction or along it.
int LapsAfterPassingBeside(double offset, bool along, bool orange) {
  Drive drive;
  drive.orange = orange;
  drive.Go(120.0, 0.0);
  // Not driven but placed: the way there does not matter.
  drive.truth = {along ? -20.0 : 30.0, offset, along ? 0.0 : kPi};
  drive.own = drive.truth;
  drive.Go(50.0, 0.0);
  return drive.counter.laps();
}

TEST(LapCounter, CountsNoLapOnANeighbouringStretch) {
  for (const bool orange : {true, false}) {
    EXPECT_EQ(LapsAfterPassingBeside(0.0, true, orange), 1) << "the gate itself";
    for (const double offset : {4.0, -4.0, 6.0, -6.0}) {
      EXPECT_EQ(LapsAfterPassingBeside(offset, false, orange), 0) << offset;
    }
    for (const double offset : {6.0, -6.0, 9.0}) {
      EXPECT_EQ(LapsAfterPassingBeside(offset, true, orange), 0) << offset;
    }
  }
  EXPECT_EQ(LapsAfterPassingBeside(4.0, true, true), 0) << "a gate that is seen is exact";
}

TEST(LapCounter, StartsTheLapByTheWayDrivenWhereTheLineWasBehindTheCar) {
  Drive drive;
  for (GateCone& cone : drive.cones) cone.position.x() -= 8.0;
  drive.Go(29.8, 0.0);
  EXPECT_FALSE(drive.counter.started());
  drive.Go(0.4, 0.0);
  EXPECT_TRUE(drive.counter.started());
  EXPECT_EQ(drive.counter.laps(), 0);
}

TEST(FindGate, NeedsEnoughMassOnBothSidesNearTheCarAtTheWidthOfATrack) {
  const GateParams params = ShippedParams().gate;
  const std::vector<GateCone> good{{{6.0, 1.5}, 0.8}, {{6.0, -1.5}, 0.8}};
  ASSERT_TRUE(FindGate(good, Pose2{}, params));
  EXPECT_NEAR(FindGate(good, Pose2{}, params)->centre.x(), 6.0, 1e-9);
  EXPECT_NEAR(FindGate(good, Pose2{}, params)->half_width, 1.5, 1e-9);
  EXPECT_NEAR(FindGate(good, Pose2{}, params)->direction.x(), 1.0, 1e-9);
  EXPECT_NEAR(FindGate(good, Pose2{12.0, 0.0, kPi}, params)->direction.x(), -1.0, 1e-9);
  EXPECT_FALSE(FindGate(good, Pose2{-10.0, 0.0, 0.0}, params)) << "too far";
  EXPECT_FALSE(FindGate({}, Pose2{}, params));
  EXPECT_FALSE(FindGate({{{6.0, 1.5}, 0.8}}, Pose2{}, params)) << "one side";
  EXPECT_FALSE(FindGate({{{6.0, 1.5}, 0.8}, {{6.0, -1.5}, 0.2}}, Pose2{}, params)) << "no mass";
  EXPECT_FALSE(FindGate({{{6.0, 0.5}, 0.8}, {{6.0, -0.5}, 0.8}}, Pose2{}, params)) << "too narrow";
  EXPECT_FALSE(FindGate({{{3.0, 5.0}, 0.8}, {{3.0, -5.0}, 0.8}}, Pose2{}, params)) << "too wide";
}

TEST(FindGate, IsNotMovedByConesThatAreHardlyOrange) {
  std::vector<GateCone> cones{{{6.0, 1.5}, 0.8}, {{6.0, -1.5}, 0.8}};
  for (const double x : {-8.0, -3.0, 2.0, 9.0}) {
    cones.push_back({{x, 1.6}, 0.25});
    cones.push_back({{x, -1.6}, 0.1});
  }
  const auto gate = FindGate(cones, Pose2{}, ShippedParams().gate);
  ASSERT_TRUE(gate);
  EXPECT_NEAR(gate->centre.x(), 6.0, 1e-9);
}

TEST(FindGate, TurnsWithTheWorld) {
  const std::vector<GateCone> cones{
      {{5.7, 1.6}, 0.9}, {{6.3, 1.5}, 0.6}, {{5.9, -1.4}, 0.8}, {{6.2, -1.7}, 0.9}};
  const Pose2 T_b_a{-30.0, 12.0, 2.2};
  std::vector<GateCone> turned = cones;
  for (GateCone& cone : turned) cone.position = T_b_a * cone.position;
  const GateParams params = ShippedParams().gate;
  const auto a = FindGate(cones, Pose2{}, params);
  const auto b = FindGate(turned, T_b_a, params);
  ASSERT_TRUE(a && b);
  EXPECT_LT((T_b_a * a->centre - b->centre).norm(), 1e-9);
  EXPECT_LT((T_b_a.rotation() * a->direction - b->direction).norm(), 1e-9);
}

// The nose 0.3 m before the line, the car's centre 1.7 m.
class Straight : public testing::Test {
 protected:
  Straight() {
    drive.cones.clear();
    for (const double x : {1.2, 2.2, 76.2, 77.2}) {
      for (const double y : {2.5, -2.5}) drive.cones.push_back({{x, y}, 0.9});
    }
  }
  Drive drive{ShippedMissions().acceleration};
};

TEST_F(Straight, IsFinishedAtTheSecondGate) {
  drive.Go(1.5, 0.0);
  EXPECT_FALSE(drive.counter.started());
  drive.Go(0.4, 0.0);
  EXPECT_TRUE(drive.counter.started());
  drive.Go(74.6, 0.0);
  EXPECT_EQ(drive.counter.laps(), 0);
  drive.Go(0.4, 0.0);
  EXPECT_EQ(drive.counter.laps(), 1);
  drive.Go(30.0, 0.0);
  EXPECT_EQ(drive.counter.laps(), 1);
}

TEST_F(Straight, IsFinishedByDeadReckoningWhereNoGateIsSeenWithinTheWayToStop) {
  drive.orange = false;
  drive.scale = 0.98;
  drive.Go(1.7 + 75.0, 0.0);
  EXPECT_TRUE(drive.counter.started());
  EXPECT_EQ(drive.counter.laps(), 0) << "never before the line";
  drive.Go(12.0, 0.0);
  EXPECT_EQ(drive.counter.laps(), 1) << "18 m are left of the 30 to stop in";
}

TEST_F(Straight, IsFinishedWhereOnlyTheFirstGateWasSeen) {
  drive.Go(20.0, 0.0);
  drive.orange = false;
  drive.Go(57.0, 0.0);
  EXPECT_EQ(drive.counter.laps(), 0);
  drive.Go(9.0, 0.0);
  EXPECT_EQ(drive.counter.laps(), 1);
}

TEST(LapCounter, RefusesWrongParameters) {
  const auto wrong = [](const std::function<void(LapCounterParams&)>& spoil) {
    LapCounterParams params = ShippedParams();
    spoil(params);
    EXPECT_THROW(LapCounter{params}, std::invalid_argument);
  };
  wrong([](auto& p) { p.gate.range = 0.0; });
  wrong([](auto& p) { p.gate.min_mass = 0.0; });
  wrong([](auto& p) { p.gate.min_cone_mass = 0.0; });
  wrong([](auto& p) { p.gate.min_width = 0.0; });
  wrong([](auto& p) { p.gate.max_width = p.gate.min_width; });
  wrong([](auto& p) { p.min_lap_length = 0.0; });
  wrong([](auto& p) { p.course_length = 0.5 * p.min_lap_length; });
  wrong([](auto& p) { p.course_length = -1.0; });
  wrong([](auto& p) { p.staging_distance = -1.0; });
  wrong([](auto& p) { p.start_within = p.staging_distance; });
  wrong([](auto& p) { p.gate_margin = -1.0; });
  wrong([](auto& p) { p.gate_memory = 0.0; });
  wrong([](auto& p) { p.blind_tolerance = 0.0; });
  wrong([](auto& p) { p.blind_overrun = -1.0; });
  wrong([](auto& p) { p.max_heading_error = 1.6; });
}

}  // namespace
}  // namespace hairpin
