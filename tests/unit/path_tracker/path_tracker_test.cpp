#include "daemons/path_tracker/path_tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/unit/path_tracker/closed_loop.hpp"

namespace hairpin {
namespace {

using namespace test;
constexpr double kPi = std::numbers::pi;

Points Hairpin() {
  return PathBuilder().Straight(40).Arc(3.0 * kPi, 1.0 / 3.0).Straight(40).Build();
}

Points Slalom() {
  PathBuilder builder;
  builder.Straight(20);
  for (int i = 0; i < 5; ++i) builder.Arc(6, 0.15).Arc(12, -0.15).Arc(6, 0.15);
  return builder.Straight(30).Build();
}

TEST(PathTracker, ReachesTwelveMetresPerSecondOnAStraightWithThirteenMetresSeen) {
  ClosedLoop loop(PathBuilder().Straight(150).Build(), ShippedParams(), {});
  const auto samples = loop.Run(8.0);
  EXPECT_GT(MaxSpeed(samples), 11.8);
  EXPECT_LT(MaxSpeed(samples), 12.1);
  EXPECT_LT(MaxAbsLateralError(samples), 0.01);
}

TEST(PathTracker, LaunchesCleanlyFromStandstill) {
  ClosedLoop loop(PathBuilder().Straight(100).Build(), ShippedParams(), {});
  const auto samples = loop.Run(2.0);
  const double most = 1.1 * ShippedParams().control.max_acceleration * 0.01;  // in one step
  double last = 0.0;
  for (const auto& sample : samples) {
    EXPECT_GE(sample.twist.vx, last - 1e-3) << sample.t;
    EXPECT_LE(sample.twist.vx - last, most + 1e-3) << sample.t;
    last = sample.twist.vx;
  }
  EXPECT_GT(last, 7.0);
}

TEST(PathTracker, StaysWithinThirtyCentimetresOfTheCentreInTheTightestHairpin) {
  ClosedLoop loop(Hairpin(), ShippedParams(), {});
  const auto samples = loop.Run(12.0);
  EXPECT_LT(MaxAbsLateralError(samples), 0.3);
  EXPECT_GT(samples.back().s, 85.0);
  for (const auto& sample : samples) {
    if (sample.s > 42.0 && sample.s < 47.0) {
      EXPECT_LT(sample.twist.vx, 5.2) << sample.s;
    }
    // It opens at 49.4; the smoothed path does so a little earlier.
    if (sample.s > 42.0 && sample.s < 49.4) {
      EXPECT_LT(sample.twist.vx, 6.6) << sample.s;
    }
  }
}

TEST(PathTracker, StaysWithinTwentyCentimetresInASlalomAndOnAConstantTurn) {
  ClosedLoop slalom(Slalom(), ShippedParams(), {});
  const auto samples = slalom.Run(25.0);
  EXPECT_LT(MaxAbsLateralError(samples), 0.2);
  EXPECT_GT(samples.back().s, 160.0);
  ClosedLoop turn(PathBuilder().Straight(10).Arc(150, 1.0 / 15.0).Build(), ShippedParams(), {});
  const auto turning = turn.Run(10.0);
  EXPECT_LT(MaxAbsLateralError(turning), 0.1);
  for (const auto& sample : turning) EXPECT_LT(std::abs(sample.lateral_acceleration), 8.5);
}

TEST(PathTracker, BearsPathsThatJumpByATenthOfAMetre) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    LoopOptions options;
    options.noise = 0.1;
    options.seed = seed;
    options.path_point_spacing = 2.5;
    ClosedLoop hairpin(Hairpin(), ShippedParams(), options);
    EXPECT_LT(MaxAbsLateralError(hairpin.Run(13.0)), 0.4) << seed;
    ClosedLoop slalom(Slalom(), ShippedParams(), options);
    EXPECT_LT(MaxAbsLateralError(slalom.Run(25.0)), 0.35) << seed;
  }
}

TEST(PathTracker, ComesBackToThePathFromTheSide) {
  for (const double side : {0.7, -0.7}) {
    ClosedLoop loop(PathBuilder().Straight(100).Build(), ShippedParams(), {});
    loop.plant.pose.y = side;
    const auto samples = loop.Run(6.0);
    double overshoot = 0.0;
    for (const auto& sample : samples) {
      overshoot = std::max(overshoot, -sample.lateral_error * (side > 0.0 ? 1.0 : -1.0));
      if (sample.s > 15.0) {
        EXPECT_LT(std::abs(sample.lateral_error), 0.1) << sample.s;
      }
    }
    EXPECT_LT(overshoot, 0.1);
  }
}

TEST(PathTracker, NeverPassesTheEndOfWhatWasSeenFromAnySpeed) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int run = 0; run < 40; ++run) {
    PathBuilder builder;
    builder.Straight(5.0 + 20.0 * uniform(random));
    for (int i = 0; i < 4; ++i) {
      builder.Arc(3.0 + 8.0 * uniform(random), 0.5 * (uniform(random) - 0.5))
          .Straight(8.0 * uniform(random));
    }
    LoopOptions options;
    options.seen_length = 6.0 + 12.0 * uniform(random);
    options.noise = 0.05;
    options.extrapolated = 0.0;
    options.seed = static_cast<unsigned>(run);
    ClosedLoop loop(builder.Build(), ShippedParams(), options);
    const auto samples = loop.Run(25.0);
    EXPECT_LT(samples.back().twist.vx, 0.01) << run;
    EXPECT_GT(samples.back().s, loop.length() - 2.5) << run;
    EXPECT_LT(samples.back().s, loop.length()) << run;
    EXPECT_LT(MaxAbsLateralError(samples), 0.5) << run;
  }
}

TEST(PathTracker, NeverReliesOnExtrapolatedPath) {
  LoopOptions options;
  options.seen_length = 6.0;
  options.extrapolated = 20.0;
  ClosedLoop loop(PathBuilder().Straight(100).Build(), ShippedParams(), options);
  for (const auto& sample : loop.Run(6.0)) {
    // The most that v <= sqrt(2 a (L - v t)) allows with the path seen at its own time.
    EXPECT_LT(sample.twist.vx, std::sqrt(2.0 * 9.0 * 6.0)) << sample.t;
    const double v = sample.command.target_speed;
    EXPECT_LE(v, std::sqrt(2.0 * 9.0 * 6.0)) << sample.t;
  }
  EXPECT_GT(loop.plant.twist.vx, 5.0);
  EXPECT_LT(loop.plant.twist.vx,
            -9.0 * 0.3 + std::sqrt(std::pow(9.0 * 0.3, 2) + 2.0 * 9.0 * 5.5) + 0.3);
}

TEST(PathTracker, MirroredInputGivesMirroredCommands) {
  for (const Points& centreline : {Hairpin(), Slalom()}) {
    ClosedLoop loop(centreline, ShippedParams(), {});
    LoopOptions options;
    options.mirror = true;
    ClosedLoop mirrored(centreline, ShippedParams(), options);
    const auto a = loop.Run(8.0);
    const auto b = mirrored.Run(8.0);
    for (size_t i = 0; i < a.size(); ++i) {
      EXPECT_NEAR(a[i].command.steering_angle, -b[i].command.steering_angle, 1e-6);
      EXPECT_NEAR(a[i].command.lateral_error, -b[i].command.lateral_error, 1e-6);
      EXPECT_NEAR(a[i].command.target_speed, b[i].command.target_speed, 1e-6);
      EXPECT_NEAR(a[i].command.wheel_torque[0], b[i].command.wheel_torque[1], 1e-4);
      EXPECT_NEAR(a[i].command.brake, b[i].command.brake, 1e-6);
    }
  }
}

TEST(PathTracker, TheSameInputGivesTheSameCommands) {
  LoopOptions options;
  options.noise = 0.05;
  ClosedLoop one(Slalom(), ShippedParams(), options);
  ClosedLoop two(Slalom(), ShippedParams(), options);
  for (int i = 0; i < 800; ++i) {
    const auto a = one.Step().command;
    const auto b = two.Step().command;
    ASSERT_EQ(a.steering_angle, b.steering_angle);
    ASSERT_EQ(a.wheel_torque, b.wheel_torque);
    ASSERT_EQ(a.brake, b.brake);
  }
}

TEST(PathTracker, EveryCommandIsWithinItsLimitsInValueAndRate) {
  LoopOptions options;
  options.noise = 0.3;  // far worse than any planner
  ClosedLoop loop(Hairpin(), ShippedParams(), options);
  const PathTrackerParams params = ShippedParams();
  TrackerCommand last;
  last.brake = params.control.hold_brake;
  for (const auto& [t, pose, twist, command, s, error, lateral] : loop.Run(10.0)) {
    EXPECT_LE(std::abs(command.steering_angle), params.car.max_steering_angle);
    EXPECT_LE(std::abs(command.steering_angle - last.steering_angle),
              params.rates.steering * 0.01 + 1e-9);
    EXPECT_GE(command.brake, 0.0);
    EXPECT_LE(command.brake, 1.0);
    EXPECT_LE(command.brake - last.brake, params.rates.brake * 0.01 + 1e-9);
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_LE(std::abs(command.wheel_torque[i]), params.car.max_wheel_torque);
      EXPECT_LE(std::abs(command.wheel_torque[i]) - std::abs(last.wheel_torque[i]),
                params.rates.torque * 0.01 + 1e-9);
    }
    last = command;
  }
}

// From full speed on a straight; what happens to the car after `fault`.
std::vector<LoopSample> After(void (*fault)(ClosedLoop&), double duration,
                              const Points& centreline) {
  ClosedLoop loop(centreline, ShippedParams(), {});
  loop.Run(4.0);
  EXPECT_GT(loop.plant.twist.vx, 7.0);
  fault(loop);
  return loop.Run(duration);
}

Points LongStraight() { return PathBuilder().Straight(200).Build(); }

TEST(PathTracker, WithoutNewPathsBrakesWithinThe500MillisecondsAndStandsBeforeTheSeenEnd) {
  const auto samples =
      After([](ClosedLoop& loop) { loop.perceiving = false; }, 4.0, LongStraight());
  const double seen_until = samples.front().s + 13.0;
  EXPECT_LT(samples.back().s, seen_until);
  EXPECT_LT(samples.back().twist.vx, 0.01);
  for (const auto& sample : samples) {
    const double since = sample.t - samples.front().t;
    if (since > 0.31) {
      EXPECT_LE(
          *std::max_element(sample.command.wheel_torque.begin(), sample.command.wheel_torque.end()),
          0.0);
    }
    if (since > 0.51) {
      EXPECT_EQ(sample.command.action, DriveAction::kStop) << since;
    }
  }
}

TEST(PathTracker, StopsOnItsPathWhereTheWatchdogOrTheMissionManagerFallsSilentOrAsksForIt) {
  for (const auto fault : {+[](ClosedLoop& loop) { loop.supervised = false; },
                           +[](ClosedLoop& loop) { loop.stop = true; }}) {
    const Points curve = PathBuilder().Straight(20).Arc(200, 1.0 / 14.0).Build();
    const auto samples = After(fault, 4.0, curve);
    EXPECT_LT(MaxAbsLateralError(samples), 0.2);
    EXPECT_LT(samples.back().twist.vx, 0.01);
    EXPECT_LT(samples.back().s - samples.front().s, 12.0);
    EXPECT_EQ(samples.back().command.action, DriveAction::kStop);
  }
}

TEST(PathTracker, StopsByFrictionBrakeWithTheSteeringKeptWhereTheVelocityIsInvalid) {
  const Points curve = PathBuilder().Straight(20).Arc(200, 1.0 / 14.0).Build();
  const auto samples = After([](ClosedLoop& loop) { loop.velocity_valid = false; }, 3.0, curve);
  for (const auto& sample : samples) {
    EXPECT_EQ(sample.command.action, DriveAction::kStop);
    EXPECT_EQ(sample.command.wheel_torque, (std::array<double, 4>{}));
    EXPECT_EQ(sample.command.steering_angle, samples.front().command.steering_angle);
  }
  EXPECT_LT(samples.back().twist.vx, 0.01);
}

TEST(PathTracker, HoldsWithoutTorqueAtOnceWhereTheStateIsNoLongerDriving) {
  const auto samples =
      After([](ClosedLoop& loop) { loop.as_driving = false; }, 4.0, LongStraight());
  for (const auto& sample : samples) {
    EXPECT_EQ(sample.command.action, DriveAction::kHold);
    EXPECT_EQ(sample.command.wheel_torque, (std::array<double, 4>{}));
  }
  EXPECT_LT(samples.back().twist.vx, 0.01);
  EXPECT_EQ(samples.back().command.brake, ShippedParams().control.hold_brake);
}

TEST(PathTracker, StopsWithinThirtyMetresAfterTheFinishAndComfortably) {
  const auto samples =
      After([](ClosedLoop& loop) { loop.mission_finished = true; }, 6.0, LongStraight());
  EXPECT_GT(samples.front().twist.vx, 11.5);
  EXPECT_LT(samples.back().s - samples.front().s, 25.0);
  EXPECT_LT(samples.back().twist.vx, 0.01);
  for (const auto& sample : samples) EXPECT_GT(sample.command.target_acceleration, -5.0);
}

TEST(PathTracker, BrakesToALowerSpeedCapDecisivelyWithoutLeavingThePathInACorner) {
  const Points curve = PathBuilder().Straight(20).Arc(200, 1.0 / 20.0).Build();
  ClosedLoop loop(curve, ShippedParams(), {});
  loop.Run(5.0);
  const double before = loop.plant.twist.vx;
  EXPECT_GT(before, 10.0);
  loop.options().speed_cap = 5.0;
  const auto samples = loop.Run(2.0);
  EXPECT_LT(MaxAbsLateralError(samples), 0.3);
  for (const auto& sample : samples) {
    if (sample.t - samples.front().t > 1.1) {
      EXPECT_NEAR(sample.twist.vx, 5.0, 0.3) << sample.t;
    }
  }
}

TEST(PathTracker, StandsStillWithoutALimitCycle) {
  ClosedLoop loop(PathBuilder().Straight(30).Build(), ShippedParams(), {});
  loop.Run(8.0);
  for (const auto& sample : loop.Run(3.0)) {
    EXPECT_EQ(sample.twist.vx, 0.0);
    EXPECT_EQ(sample.command.wheel_torque, (std::array<double, 4>{}));
    EXPECT_EQ(sample.command.brake, ShippedParams().control.hold_brake);
  }
}

PathInput StraightAhead(int64_t utime) {
  PathInput path;
  path.utime = utime;
  for (int i = 0; i <= 24; ++i) path.points.emplace_back(0.5 * i, 0.0);
  path.num_seen = path.points.size();
  path.seen_length = 12.0;
  return path;
}

TEST(PathTracker, RefusesPathsThatAreOldRepeatedOrOutsideItsHistory) {
  PathTracker tracker(ShippedParams());
  EXPECT_NE(tracker.TakePath(StraightAhead(1'000'000)), "");  // no velocity yet
  for (int i = 0; i <= 100; ++i) tracker.Answer(1'000'000 + i * 10'000, Twist2{1.0, 0.0, 0.0});
  EXPECT_EQ(tracker.TakePath(StraightAhead(1'690'000)), "too old to drive on");
  EXPECT_EQ(tracker.TakePath(StraightAhead(1'900'000)), "");
  EXPECT_EQ(tracker.TakePath(StraightAhead(1'900'000)), "no newer than the last path");
  EXPECT_EQ(tracker.TakePath(StraightAhead(1'800'000)), "no newer than the last path");
  EXPECT_EQ(tracker.TakePath(StraightAhead(2'200'000)), "its time is outside the pose history");
  PathInput empty = StraightAhead(1'950'000);
  empty.points.assign(2, {1.0, 0.0});
  empty.T_local_base = {1.0, 0.0, 0.0};
  EXPECT_EQ(tracker.TakePath(empty), "ReferencePath: the path has no length");
}

TEST(PathTracker, AnswersNoVelocityWhoseTimeDoesNotIncrease) {
  PathTracker tracker(ShippedParams());
  EXPECT_TRUE(tracker.Answer(2'000'000, Twist2{}));
  EXPECT_FALSE(tracker.Answer(2'000'000, Twist2{}));
  EXPECT_FALSE(tracker.Answer(1'990'000, Twist2{}));
  EXPECT_TRUE(tracker.Answer(2'010'000, Twist2{}));
}

TEST(PathTracker, RefusesWrongParameters) {
  const auto wrong = [](auto spoil) {
    PathTrackerParams params = ShippedParams();
    spoil(params);
    EXPECT_THROW(PathTracker{params}, std::invalid_argument);
  };
  wrong([](auto& p) { p.control.gain = 0.0; });
  wrong([](auto& p) { p.control.max_acceleration = 0.0; });
  wrong([](auto& p) { p.control.max_braking = p.speed.braking - 0.1; });
  wrong([](auto& p) { p.control.delay = -0.1; });
  wrong([](auto& p) { p.control.standstill_speed = 0.0; });
  wrong([](auto& p) { p.control.launch_speed = p.control.standstill_speed; });
  wrong([](auto& p) { p.control.hold_brake = 1.1; });
  wrong([](auto& p) { p.rates.steering = 0.0; });
  wrong([](auto& p) { p.rates.torque = 0.0; });
  wrong([](auto& p) { p.rates.brake = 0.0; });
  wrong([](auto& p) { p.reaction_time = -0.1; });
  wrong([](auto& p) { p.steering_delay = -0.1; });
  wrong([](auto& p) { p.path.spacing = 0.0; });
  wrong([](auto& p) { p.speed.braking = 0.0; });
  wrong([](auto& p) { p.gate.max_path_age = 0.1; });
  wrong([](auto& p) { p.steering.min_lookahead = 0.0; });
  wrong([](auto& p) { p.steering.lookahead_time = -1.0; });
  wrong([](auto& p) { p.steering.damping = 0.0; });
  wrong([](auto& p) { p.steering.front_cornering_stiffness = 0.0; });
  wrong([](auto& p) { p.steering.rear_cornering_stiffness = 0.0; });
  wrong([](auto& p) { p.steering.max_lateral_acceleration = 0.0; });
  wrong([](auto& p) { p.forces.drag = -1.0; });
  wrong([](auto& p) { p.forces.rolling_resistance = -1.0; });
  wrong([](auto& p) { p.forces.grip = 0.0; });
  wrong([](auto& p) { p.forces.min_braking = p.forces.grip + 1.0; });
  wrong([](auto& p) { p.forces.max_regeneration = -1.0; });
  wrong([](auto& p) { p.forces.regeneration_fade_speed = 0.0; });
}

}  // namespace
}  // namespace hairpin
