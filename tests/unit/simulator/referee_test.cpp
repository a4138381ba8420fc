#include "tools/simulator/referee.hpp"

#include <gtest/gtest.h>

#include "tests/support/oval_track.hpp"
#include "tests/support/simulator_setup.hpp"

namespace hairpin {
namespace {

constexpr int64_t kStart = 1'700'000'000'000'000;
constexpr int64_t kTick = 10'000;

// Moves a car over the oval as on rails and tells the referee.
class Drive {
 public:
  explicit Drive(const RefereeParams& params = ShippedSimulatorParams().referee,
                 const Track& track = OvalTrack())
      : referee(params, ShippedCar(), track) {}

  // One tick at `pose`, with `speed` [m/s].
  void At(const Pose2& pose, double speed, bool driving = true, bool finished = false) {
    state.T_map_base = pose;
    state.velocity.vx = speed;
    state.distance += std::abs(speed) * 0.01;
    RefereeInput input;
    input.utime = kStart + kTick * tick++;
    input.driving = driving;
    input.finished = finished;
    input.emergency = emergency;
    input.res_stop = res_stop;
    referee.Judge(input, state);
  }

  // From arc length `from` to `to` [m] along the middle line, backward if `to` is less.
  void Along(double from, double to, double speed, double offset = 0.0) {
    const double direction = to > from ? 1.0 : -1.0;
    for (double s = from; direction * (to - s) >= 0.0; s += direction * speed * 0.01) {
      At(OvalPose(s) * Pose2{0.0, offset, 0.0}, direction * speed);
    }
  }

  void Stand(double s, double seconds, bool finished) {
    for (int i = 0; i < static_cast<int>(seconds * 100.0); ++i)
      At(OvalPose(s), 0.0, !finished, finished);
  }

  Referee referee;
  VehicleState state;
  std::string emergency;
  bool res_stop = false;
  int64_t tick = 0;
};

TEST(Referee, TimesALapFromTheFirstCrossingAndSeesItFinished) {
  Drive drive;
  const double length = OvalLength();
  drive.Along(-3.0, length + 10.0, 10.0);
  ASSERT_EQ(drive.referee.laps(), 1);
  EXPECT_NEAR(drive.referee.result().lap_times_s[0], length / 10.0, 0.011);
  EXPECT_FALSE(drive.referee.done());
  drive.Stand(length + 10.0, 1.0, true);
  EXPECT_TRUE(drive.referee.done());
  const RaceResult& result = drive.referee.result();
  EXPECT_TRUE(result.finished) << result.reason;
  EXPECT_EQ(result.cones_hit, 0);
  EXPECT_EQ(result.off_course, 0);
  EXPECT_NEAR(result.mean_speed_mps, 10.0, 0.02);
  EXPECT_EQ(result.max_speed_mps, 10.0);
}

TEST(Referee, CountsEachLapOnce) {
  RefereeParams params = ShippedSimulatorParams().referee;
  params.laps = 3;
  Drive drive(params);
  drive.Along(-3.0, 3.0 * OvalLength() + 5.0, 10.0);
  EXPECT_EQ(drive.referee.laps(), 3);
}

TEST(Referee, DoesNotCountALineCrossedBackwardAndForwardAgain) {
  Drive drive;
  drive.Along(-3.0, 5.0, 5.0);
  for (int i = 0; i < 3; ++i) {
    drive.Along(5.0, -5.0, 5.0);
    drive.Along(-5.0, 5.0, 5.0);
  }
  EXPECT_EQ(drive.referee.laps(), 0);
  drive.Along(5.0, OvalLength() + 1.0, 10.0);
  EXPECT_EQ(drive.referee.laps(), 1);
}

TEST(Referee, DoesNotCountALapDrivenTheWrongWay) {
  Drive drive;
  drive.Along(3.0, -OvalLength() - 5.0, 10.0);
  EXPECT_EQ(drive.referee.laps(), 0);
}

TEST(Referee, CountsAConeHitOnceAndTakesItAway) {
  Drive drive;
  const size_t before = drive.referee.standing_cones().size();
  // 0.9 m to the left the body, 0.7 m to each side, reaches 1.6 m: cones of 0.114 m stand at 1.75
  // m.
  drive.Along(-2.0, 8.0, 5.0, 0.9);
  EXPECT_EQ(drive.referee.result().cones_hit, 0);
  Drive closer;
  closer.Along(1.0, 8.0, 5.0, 1.0);
  const int hit = closer.referee.result().cones_hit;
  EXPECT_GT(hit, 0);
  EXPECT_EQ(closer.referee.standing_cones().size(), before - static_cast<size_t>(hit));
  closer.Along(8.0, 1.0, 5.0, 1.0);
  EXPECT_EQ(closer.referee.result().cones_hit, hit);
}

TEST(Referee, KnowsTheBodysEnds) {
  Track track = OvalTrack();
  track.others.assign(1, {{10.0, 0.0}, ConeColour::kOrange});
  Drive drive(ShippedSimulatorParams().referee, track);
  const double reach = ShippedCar().front_overhang + 0.114;
  drive.At(OvalPose(10.0 - reach - 0.01), 1.0);
  EXPECT_EQ(drive.referee.result().cones_hit, 0);
  drive.At(OvalPose(10.0 - reach + 0.01), 1.0);
  EXPECT_EQ(drive.referee.result().cones_hit, 1);
}

TEST(Referee, CountsAnExcursionOnlyWithAllFourWheelsOutside) {
  Drive drive;
  drive.Along(1.0, 5.0, 5.0, 2.0);  // the left wheels alone
  EXPECT_EQ(drive.referee.result().off_course, 0);
  drive.Along(5.0, 9.0, 5.0, 3.0);
  EXPECT_EQ(drive.referee.result().off_course, 1);
  drive.Along(9.0, 11.0, 5.0, 4.0);
  EXPECT_EQ(drive.referee.result().off_course, 1);
  drive.Along(11.0, 12.0, 5.0, 0.0);
  drive.Along(12.0, 13.0, 5.0, -3.0);
  EXPECT_EQ(drive.referee.result().off_course, 2);
}

TEST(Referee, WantsTheCarToStopWithin30MetresOfTheFinish) {
  Drive drive;
  drive.Along(-3.0, OvalLength() + 29.5, 10.0);
  EXPECT_FALSE(drive.referee.done());
  drive.Along(OvalLength() + 29.5, OvalLength() + 31.0, 10.0);
  EXPECT_TRUE(drive.referee.done());
  EXPECT_FALSE(drive.referee.result().finished);
  EXPECT_NE(drive.referee.result().reason.find("30 m"), std::string::npos);
}

TEST(Referee, WantsAsFinishedWithin30Seconds) {
  Drive drive;
  drive.Along(-3.0, OvalLength() + 10.0, 10.0);
  drive.Stand(OvalLength() + 10.0, 28.0, false);
  EXPECT_FALSE(drive.referee.done());
  drive.Stand(OvalLength() + 10.0, 3.0, false);
  EXPECT_TRUE(drive.referee.done());
  EXPECT_FALSE(drive.referee.result().finished);
}

TEST(Referee, EndsADriveWithoutMovement) {
  Drive drive;
  drive.Along(-3.0, 20.0, 5.0);
  drive.Stand(20.0, 19.5, false);
  EXPECT_FALSE(drive.referee.done());
  drive.Stand(20.0, 1.0, false);
  EXPECT_TRUE(drive.referee.done());
  EXPECT_NE(drive.referee.result().reason.find("no movement"), std::string::npos);
}

TEST(Referee, EndsADriveThatTakesTooLong) {
  RefereeParams params = ShippedSimulatorParams().referee;
  params.time_limit_per_lap_s = 5.0;
  Drive drive(params);
  drive.Along(-3.0, 30.0, 5.0);
  EXPECT_TRUE(drive.referee.done());
  EXPECT_NE(drive.referee.result().reason.find("time limit"), std::string::npos);
}

TEST(Referee, EndsADriveThatDoesNotStart) {
  Drive drive;
  for (int i = 0; i < 6100; ++i) drive.At(OvalPose(-3.0), 0.0, false);
  EXPECT_TRUE(drive.referee.done());
  EXPECT_NE(drive.referee.result().reason.find("did not start"), std::string::npos);
}

TEST(Referee, EndsADriveByTheEmergencyBrakeOnceTheCarStands) {
  Drive drive;
  drive.Along(-3.0, 10.0, 5.0);
  drive.emergency = "commands have ceased";
  drive.Along(10.0, 11.0, 5.0);
  EXPECT_FALSE(drive.referee.done());
  drive.Stand(11.0, 0.1, false);
  EXPECT_TRUE(drive.referee.done());
  EXPECT_NE(drive.referee.result().reason.find("commands have ceased"), std::string::npos);
}

class BrakeTest : public testing::Test {
 protected:
  static RefereeParams Params() {
    RefereeParams params = ShippedSimulatorParams().referee;
    params.braking_distance_m = 10.0;
    return params;
  }
  // At 11 m/s, then along the oval until the car stands, `length` on.
  void BrakeWithin(double length) {
    drive.Along(-3.0, 20.0, 11.0);
    drive.emergency = "stopped by the RES";
    drive.Along(20.0, 20.0 + length, 5.0);
    drive.Stand(20.0 + length, 0.1, false);
  }
  Drive drive{Params()};
};

TEST_F(BrakeTest, IsPassedWhereTheCarStandsInTimeOnceTheResWasPressed) {
  drive.res_stop = true;
  BrakeWithin(9.5);
  EXPECT_TRUE(drive.referee.done());
  EXPECT_TRUE(drive.referee.result().finished) << drive.referee.result().reason;
  EXPECT_EQ(drive.referee.result().reason, "brake test: stands 9.5 m after the RES");
}

TEST_F(BrakeTest, IsFailedWhereTheCarRollsOn) {
  drive.res_stop = true;
  BrakeWithin(10.5);
  EXPECT_TRUE(drive.referee.done());
  EXPECT_FALSE(drive.referee.result().finished);
}

TEST_F(BrakeTest, IsFailedByAnotherEmergency) {
  drive.emergency = "commands have ceased";
  BrakeWithin(5.0);
  EXPECT_TRUE(drive.referee.done());
  EXPECT_FALSE(drive.referee.result().finished);
}

TEST(Referee, FinishesAnOpenTrackAtItsOwnLine) {
  Track track;
  track.closed = false;
  track.start_line = {{0.0, 1.5}, {0.0, -1.5}};
  track.finish_line = {{75.0, 1.5}, {75.0, -1.5}};
  for (double x = 0.0; x <= 75.0; x += 5.0) {
    track.left.push_back({{x, 1.5}, ConeColour::kBlue});
    track.right.push_back({{x, -1.5}, ConeColour::kYellow});
  }
  Drive drive(ShippedSimulatorParams().referee, track);
  for (double x = -2.0; x < 90.0; x += 0.1) drive.At({x, 0.0, 0.0}, 10.0);
  for (int i = 0; i < 100; ++i) drive.At({90.0, 0.0, 0.0}, 0.0, false, true);
  EXPECT_TRUE(drive.referee.result().finished) << drive.referee.result().reason;
  EXPECT_NEAR(drive.referee.result().lap_times_s.at(0), 7.5, 0.011);
  EXPECT_EQ(drive.referee.result().off_course, 0);
}

TEST(Referee, RefusesParametersThatCannotBe) {
  RefereeParams params = ShippedSimulatorParams().referee;
  params.laps = 0;
  EXPECT_THROW(Referee(params, ShippedCar(), OvalTrack()), std::invalid_argument);
  params = ShippedSimulatorParams().referee;
  params.stop_distance_m = -1.0;
  EXPECT_THROW(Referee(params, ShippedCar(), OvalTrack()), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
