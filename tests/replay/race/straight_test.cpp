// The missions on a straight, by the whole stack.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/race_run.hpp"

namespace hairpin {
namespace {

using testing::StartsWith;

/// The track of the missions on a straight, 3.5 m wide, with its sides moved to another width [m].
Track StraightOfWidth(double width) {
  Track track = LoadTrack(std::string(HAIRPIN_SOURCE_DIR) + "/config/tracks/acceleration.yaml");
  const auto move = [width](Eigen::Vector2d& point) {
    point.y() += std::copysign(0.5 * (width - 3.5), point.y());
  };
  for (auto* cones : {&track.left, &track.right, &track.others}) {
    for (TrackCone& cone : *cones) move(cone.position);
  }
  for (GateLine* line : {&track.start_line, &track.finish_line}) {
    move(line->left);
    move(line->right);
  }
  return track;
}

RaceRun RunOnStraight(int32_t mission, uint64_t seed, std::vector<std::string> overrides = {},
                      double width = 3.5) {
  overrides.push_back("simulator.race_control.mission=" + std::to_string(mission));
  const TemporaryFolder folder;
  SaveTrack(StraightOfWidth(width), folder.File("straight.yaml"));
  return RunInProcess(folder.File("straight.yaml"), seed, {}, overrides);
}

struct Straight {
  double width = 0.0;  // m
  uint64_t seed = 0;
};

class Acceleration : public testing::TestWithParam<Straight> {};

TEST_P(Acceleration, IsDrivenCleanlyAndEndsStandingBehindTheFinish) {
  const RaceRun run =
      RunOnStraight(vehicle_t::MISSION_ACCELERATION, GetParam().seed, {}, GetParam().width);
  const RaceResult& result = run.outcome.result;
  EXPECT_TRUE(result.finished) << result.reason;
  EXPECT_EQ(result.cones_hit, 0);
  EXPECT_EQ(result.off_course, 0);
  ASSERT_EQ(result.lap_times_s.size(), 1u);
  EXPECT_LT(result.lap_times_s[0], 9.0);
  EXPECT_EQ(run.log.as_states.back().state, as_state_t::STATE_FINISHED);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Acceleration,
                         testing::Values(Straight{3.5, 1}, Straight{3.5, 2}, Straight{3.5, 3}));
// As wide as its cones stand apart: what lies between four of them is a square, with a diagonal
// longer than any track is wide.
INSTANTIATE_TEST_SUITE_P(Wide, Acceleration,
                         testing::Values(Straight{5.0, 7}, Straight{5.0, 9}, Straight{5.0, 10}));

TEST(BrakeTest, ReachesItsSpeedWithin20MetresAndStandsWithin10OfTheRes) {
  const RaceRun run = RunOnStraight(vehicle_t::MISSION_BRAKE_TEST, 1,
                                    {"simulator.race_control.res_stop_speed_mps=11.2",
                                     "simulator.referee.braking_distance_m=10"});
  const RaceResult& result = run.outcome.result;
  EXPECT_TRUE(result.finished) << result.reason;
  EXPECT_THAT(result.reason, StartsWith("brake test: stands "));
  EXPECT_EQ(result.cones_hit, 0);
  EXPECT_GE(result.max_speed_mps, 40.0 / 3.6);
  EXPECT_LE(result.distance_m, 1.7 + 20.0 + 10.0);
  EXPECT_EQ(run.log.as_states.back().state, as_state_t::STATE_EMERGENCY);
}

}  // namespace
}  // namespace hairpin
