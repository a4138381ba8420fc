#include "daemons/global_mapper/race_line/race_line.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "tests/unit/race_line/synthetic_lap.hpp"

namespace hairpin {
namespace {

double FarthestApart(const RaceLine& a, const std::vector<Eigen::Vector2d>& b) {
  double worst = 0.0;
  for (const RaceLine::Point& point : a.points) {
    double nearest = 1e9;
    for (const Eigen::Vector2d& other : b)
      nearest = std::min(nearest, (point.position - other).norm());
    worst = std::max(worst, nearest);
  }
  return worst;
}

std::vector<Eigen::Vector2d> PositionsOf(const RaceLine& line) {
  std::vector<Eigen::Vector2d> positions;
  for (const RaceLine::Point& point : line.points) positions.push_back(point.position);
  return positions;
}

SyntheticLap Moved(SyntheticLap lap, const Pose2& T) {
  for (Eigen::Vector2d& point : lap.driven) point = T * point;
  for (MappedCone& cone : lap.cones) cone.position = T * cone.position;
  return lap;
}

TEST(RaceLine, OnACircleIsTheWidestCircleThatTheCarFits) {
  // Of all closed lines round it the widest circle has the least integral of squared curvature,
  // 2 pi / r; the cones stand close enough for the chord to be the circle.
  const RaceLine line = Plan(CircularLap(20.0, 3.0, 0.5));
  const Car car = TestCar();
  const double fits = 23.0 - 0.3 - SweptBy(car, 1.0 / 21.9).outer;
  for (const RaceLine::Point& point : line.points) EXPECT_NEAR(point.position.norm(), fits, 0.06);
  EXPECT_NEAR(line.lap_time, 2.0 * std::numbers::pi * fits / std::sqrt(8.0 * fits), 0.05);
}

TEST(RaceLine, BendsLessAndIsFasterThanTheCentreLine) {
  const SyntheticLap lap = WavyLap();
  const RaceLineParams params = TestRaceLineParams();
  const Corridor corridor(lap.cones, lap.driven, params.car, params.corridor);
  const ClosedCurve line = MinimumCurvatureLine(corridor, params.line);
  EXPECT_LT(line.SquaredCurvature(), 0.8 * corridor.centre().SquaredCurvature());
  EXPECT_LT(WithSpeeds(line, corridor, params.speed).lap_time,
            0.95 * WithSpeeds(corridor.centre(), corridor, params.speed).lap_time);
}

TEST(RaceLine, KeepsTheSweptBodyAndTheClearanceFromEveryCone) {
  const SyntheticLap lap = WavyLap(1.8);
  const RaceLineParams params = TestRaceLineParams();
  for (const RaceLine::Point& point : Plan(lap, params).points) {
    EXPECT_GE(std::min(point.left, point.right), 0.7 + 0.3 - 0.05);
    for (const MappedCone& cone : lap.cones)
      EXPECT_GE((cone.position - point.position).norm(), 0.7 + 0.3 - 0.05);
  }
}

TEST(RaceLine, NoSmallChangeOfItBendsLess) {
  // A stationary point of the true integral, not only of the programme that approximates it: on a
  // lap wide enough to leave room, waves of 15 m and more lengthen or bend it.
  const SyntheticLap lap = WavyLap(2.0);
  RaceLineParams params = TestRaceLineParams();
  params.line.tolerance = 0.002;
  params.line.max_iterations = 100;
  const Corridor corridor(lap.cones, lap.driven, params.car, params.corridor);
  const ClosedCurve line = MinimumCurvatureLine(corridor, params.line);
  const double least = line.SquaredCurvature();
  for (int wave = 0; wave < 12; ++wave) {
    Points changed;
    for (size_t i = 0; i < line.size(); ++i) {
      const auto room = corridor.RoomAt(line.points()[i], line.normal(i), line.curvature()[i]);
      const double wanted =
          0.05 * std::sin(2.0 * std::numbers::pi * static_cast<double>(wave) *
                              static_cast<double>(i) / static_cast<double>(line.size()) +
                          0.7 * wave);
      const double low = std::min(room.right, 0.0);
      const double high = std::max(room.left, 0.0);
      changed.push_back(line.points()[i] + std::clamp(wanted, low, high) * line.normal(i));
    }
    EXPECT_GT(ClosedCurve(changed, line.spacing()).SquaredCurvature(), 0.998 * least) << wave;
  }
}

TEST(RaceLine, TurnsWithTheWorld) {
  const SyntheticLap lap = WavyLap();
  const Pose2 T{12.0, -7.0, 2.1};
  const RaceLine line = Plan(lap);
  RaceLine turned = line;
  for (RaceLine::Point& point : turned.points) point.position = T * point.position;
  const RaceLine other = Plan(Moved(lap, T));
  EXPECT_LT(FarthestApart(turned, PositionsOf(other)), 0.02);
  EXPECT_NEAR(line.lap_time, other.lap_time, 1e-2);
}

TEST(RaceLine, IsMirroredWithTheWorld) {
  SyntheticLap lap = WavyLap();
  RaceLine mirrored = Plan(lap);
  const auto mirror = [](const Eigen::Vector2d& p) { return Eigen::Vector2d(p.x(), -p.y()); };
  for (RaceLine::Point& point : mirrored.points) point.position = mirror(point.position);
  for (Eigen::Vector2d& point : lap.driven) point = mirror(point);
  for (MappedCone& cone : lap.cones) {
    cone.position = mirror(cone.position);
    const bool blue = cone.colour == ConeColour::kBlue;
    cone.colour = blue ? ConeColour::kYellow : ConeColour::kBlue;
  }
  EXPECT_LT(FarthestApart(mirrored, PositionsOf(Plan(lap))), 0.05);
}

TEST(RaceLine, DoesNotDependOnTheOrderOfTheCones) {
  SyntheticLap lap = WavyLap();
  const RaceLine line = Plan(lap);
  std::mt19937 random(1);
  std::shuffle(lap.cones.begin(), lap.cones.end(), random);
  EXPECT_EQ(FarthestApart(line, PositionsOf(Plan(lap))), 0.0);
}

TEST(RaceLine, SurvivesMissingConesWrongColoursAndThingsBesideTheTrack) {
  const SyntheticLap whole = WavyLap();
  SyntheticLap lap = whole;
  for (size_t i = 0; i < lap.cones.size(); i += 9) lap.cones[i].colour = ConeColour::kUnknown;
  lap.cones[10].colour = ConeColour::kYellow;  // it was blue
  const Eigen::Vector2d outward = lap.driven[50].normalized();
  lap.cones.push_back({lap.driven[50] + 5.0 * outward, ConeColour::kUnknown});
  lap.cones.erase(lap.cones.begin() + 40);
  lap.cones.erase(lap.cones.begin() + 25);
  for (const RaceLine::Point& point : Plan(lap).points) {
    for (const MappedCone& cone : whole.cones)
      EXPECT_GE((cone.position - point.position).norm(), 0.75);
  }
}

TEST(RaceLine, RefusesALapWithoutSides) {
  SyntheticLap lap = WavyLap();
  EXPECT_THROW(PlanRaceLine({}, lap.driven, TestRaceLineParams()), std::invalid_argument);
  EXPECT_THROW(PlanRaceLine(lap.cones, {}, TestRaceLineParams()), std::invalid_argument);
}

TEST(SweptBy, ReachesTheCornersOfACarThatRollsOnACircle) {
  const Car car = TestCar();
  const SweptWidth straight = SweptBy(car, 0.0);
  EXPECT_DOUBLE_EQ(straight.inner, 0.7);
  EXPECT_DOUBLE_EQ(straight.outer, 0.7);
  // Base on a circle of 5 m: the rear axle's middle on one of sqrt(25 - 0.81^2).
  const double rear = std::sqrt(25.0 - 0.81 * 0.81);
  EXPECT_NEAR(SweptBy(car, -0.2).outer, std::hypot(rear + 0.7, 0.81 + 1.4) - 5.0, 1e-12);
  EXPECT_NEAR(SweptBy(car, 0.2).inner, 5.0 - (rear - 0.7), 1e-12);
}

TEST(LapOf, CutsOneLapOutOfADriveThatOverruns) {
  Points drive;
  for (int i = -10; i < 220; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 200;
    const double drift = 0.002 * i;  // a gap of 0.4 m after a lap
    drive.emplace_back((20.0 + drift) * std::cos(angle), (20.0 + drift) * std::sin(angle));
  }
  const Points lap = LapOf(drive, 100.0);
  const ClosedCurve curve(lap, 0.5);
  EXPECT_NEAR(curve.length(), 2.0 * std::numbers::pi * 20.2, 0.5);
  for (const double k : curve.curvature()) EXPECT_NEAR(k, 0.05, 0.03);
}

TEST(LapOf, TakesADriveThatEndsBehindItsBeginningAsItIs) {
  Points drive;
  for (int i = 0; i < 180; ++i) {  // 12.6 m are missing
    const double angle = 2.0 * std::numbers::pi * i / 200;
    drive.emplace_back(20.0 * std::cos(angle), 20.0 * std::sin(angle));
  }
  EXPECT_EQ(LapOf(drive, 100.0).size(), drive.size());
  drive.resize(120);  // 46 m are missing
  EXPECT_THROW(LapOf(drive, 50.0), std::invalid_argument);
}

TEST(LapOf, RefusesADriveThatDoesNotComeBack) {
  Points drive;
  for (int i = 0; i < 300; ++i) drive.emplace_back(1.0 * i, 0.0);
  EXPECT_THROW(LapOf(drive, 100.0), std::invalid_argument);
}

TEST(Excerpt, BeginsBehindTheCarAndGoesOnPastTheEndOfTheLap) {
  const RaceLine line = Plan(CircularLap(20.0, 3.0));
  const double last = line.spacing * static_cast<double>(line.points.size() - 4);
  const double angle = last / 22.0;
  const Pose2 car{22.0 * std::cos(angle), 22.0 * std::sin(angle), angle + std::numbers::pi / 2};
  const auto stretch = Excerpt(line, car, 3.0, 40.0);
  ASSERT_EQ(stretch.size(), 1u + static_cast<size_t>(std::lround(3.0 / line.spacing)) +
                                static_cast<size_t>(std::lround(40.0 / line.spacing)));
  for (size_t i = 1; i < stretch.size(); ++i)
    EXPECT_NEAR((stretch[i].position - stretch[i - 1].position).norm(), line.spacing, 0.05);
  EXPECT_LT(
      (stretch[static_cast<size_t>(std::lround(3.0 / line.spacing))].position - car.position())
          .norm(),
      1.5);
}

TEST(Excerpt, IsEmptyWhereTheCarIsNotOnTheLineOrFacesTheOtherWay) {
  const RaceLine line = Plan(CircularLap(20.0, 3.0));
  EXPECT_TRUE(Excerpt(line, {0.0, 0.0, 0.0}, 3.0, 40.0).empty());
  EXPECT_TRUE(Excerpt(line, {20.0, 0.0, -std::numbers::pi / 2}, 3.0, 40.0).empty());
}

}  // namespace
}  // namespace hairpin
