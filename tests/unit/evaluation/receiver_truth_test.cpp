#include "tools/evaluation/receiver_truth.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "common/geometry.hpp"
#include "tests/support/oval_track.hpp"
#include "tools/report/trajectory.hpp"

namespace hairpin {
namespace {

constexpr int64_t kStart = 1'795'523'719'000'000;
constexpr double kPeriod = 0.1;  // s
constexpr double kSpeed = 10.0;  // m/s
const ReceiverTruthParams kParams{
    .antenna = {-0.3, 0.2}, .max_position_sigma = 0.05, .max_heading_sigma = 0.01};

/// What a receiver without noise says of a car on the oval's middle line, base always along it,
/// `distance` [m] from the start line.
gnss_t FixAt(int64_t utime, double distance) {
  const Pose2 T_map_base = OvalPose(distance);
  const double ahead = WrapAngle(OvalPose(distance + 1e-4).yaw - OvalPose(distance - 1e-4).yaw);
  const double yaw_rate = ahead / 2e-4 * kSpeed;
  const Eigen::Vector2d position = T_map_base * kParams.antenna;
  const Eigen::Vector2d velocity =
      T_map_base.rotation() *
      Eigen::Vector2d(kSpeed - yaw_rate * kParams.antenna.y(), yaw_rate * kParams.antenna.x());
  gnss_t fix{};
  fix.utime = utime;
  fix.fix = gnss_t::FIX_RTK;
  for (int i = 0; i < 2; ++i) {
    fix.position_enu_m[i] = position[i];
    fix.position_sigma_m[i] = 0.015;
    fix.velocity_enu_mps[i] = velocity[i];
  }
  fix.heading_valid = 1;
  fix.heading_rad = T_map_base.yaw;
  fix.heading_sigma_rad = 0.005;
  return fix;
}

/// From `begin` [m] on, for so many seconds.
std::vector<gnss_t> Drive(double begin, double seconds) {
  std::vector<gnss_t> fixes;
  const int count = static_cast<int>(std::lround(seconds / kPeriod));
  for (int i = 0; i <= count; ++i)
    fixes.push_back(FixAt(kStart + 100'000 * i, begin + kSpeed * kPeriod * i));
  return fixes;
}

ReceiverTruth TruthOf(const std::vector<gnss_t>& fixes) {
  return TruthOfReceiver(fixes, OvalTrack(), kParams);
}

TEST(ReceiverTruth, IsThePoseAndMotionOfBaseNotOfTheAntenna) {
  const std::vector<gnss_t> fixes = Drive(25.0, 2.5);  // in a bend of 12 m
  const ReceiverTruth result = TruthOf(fixes);
  ASSERT_EQ(result.truth.size(), fixes.size());
  for (size_t i = 0; i < fixes.size(); ++i) {
    const truth_t& truth = result.truth[i];
    const Pose2 expected = OvalPose(25.0 + static_cast<double>(i));
    EXPECT_EQ(truth.utime, fixes[i].utime);
    EXPECT_NEAR(truth.x_m, expected.x, 1e-9);
    EXPECT_NEAR(truth.y_m, expected.y, 1e-9);
    EXPECT_NEAR(WrapAngle(truth.yaw_rad - expected.yaw), 0.0, 1e-9);
    EXPECT_NEAR(truth.yaw_rate_radps, kSpeed / 12.0, 1e-6);
    EXPECT_NEAR(truth.vx_mps, kSpeed, 1e-6);
    EXPECT_NEAR(truth.vy_mps, 0.0, 1e-6);
  }
  EXPECT_TRUE(result.gaps.empty());
}

TEST(ReceiverTruth, LeavesOutWhatIsNoFixedSolutionAndCountsWhy) {
  std::vector<gnss_t> fixes = Drive(0.0, 3.0);
  fixes[3].fix = gnss_t::FIX_FLOAT;
  fixes[4].fix = gnss_t::FIX_FLOAT;
  fixes[6].fix = gnss_t::FIX_DIFFERENTIAL;
  fixes[8].fix = gnss_t::FIX_SINGLE;
  fixes[10].fix = gnss_t::FIX_NONE;
  fixes[11].fix = gnss_t::FIX_UNKNOWN;
  fixes[13].heading_valid = 0;
  fixes[15].position_sigma_m[1] = 0.06;
  fixes[17].heading_sigma_rad = 0.02;
  fixes[19] = fixes[18];
  fixes[19].utime += 100'000;  // says the same again
  fixes[21].utime = fixes[20].utime;
  const ReceiverTruth result = TruthOf(fixes);
  const std::map<std::string, int64_t> expected{
      {"float", 2},      {"differential", 1}, {"single", 1}, {"no_fix", 2},
      {"no_heading", 1}, {"uncertain", 2},    {"stale", 2},  {"lone", 0}};
  EXPECT_EQ(result.left_out, expected);
  EXPECT_EQ(result.truth.size(), fixes.size() - 11);
}

TEST(ReceiverTruth, InventsNothingInAGapAndTellsIt) {
  std::vector<gnss_t> fixes = Drive(0.0, 10.0);
  for (size_t i = 30; i < 50; ++i) fixes[i].fix = gnss_t::FIX_FLOAT;
  const ReceiverTruth result = TruthOf(fixes);
  ASSERT_EQ(result.gaps.size(), 1u);
  EXPECT_EQ(result.gaps[0].from_utime, fixes[29].utime);
  EXPECT_EQ(result.gaps[0].to_utime, fixes[50].utime);
  RunLog log;
  log.truth = result.truth;
  const TrueTrajectory trajectory(log);
  EXPECT_TRUE(trajectory.At(fixes[29].utime));
  EXPECT_FALSE(trajectory.At(fixes[40].utime));
  EXPECT_TRUE(trajectory.At(fixes[50].utime));
  // Between 29 and 50 m lies a bend: the straight line through it is shorter.
  EXPECT_LT(result.truth.back().distance_m, 99.0);
  EXPECT_GT(result.truth.back().distance_m, 94.0);
}

TEST(ReceiverTruth, LeavesOutASolutionWithoutNeighboursSinceItTellsNoYawRate) {
  std::vector<gnss_t> fixes = Drive(0.0, 4.0);
  for (size_t i = 10; i < 30; ++i) {
    if (i != 20) fixes[i].fix = gnss_t::FIX_FLOAT;
  }
  const ReceiverTruth result = TruthOf(fixes);
  EXPECT_EQ(result.left_out.at("lone"), 1);
  EXPECT_EQ(result.truth.size(), 21u);
  EXPECT_EQ(result.gaps.size(), 1u);
}

TEST(ReceiverTruth, CountsLapsAndTheWayAlongThem) {
  const double length = OvalLength();
  const std::vector<gnss_t> fixes = Drive(-3.0, (2.0 * length + 10.0) / kSpeed);
  const ReceiverTruth result = TruthOf(fixes);
  EXPECT_EQ(result.truth.front().lap, 0);
  EXPECT_EQ(result.truth.back().lap, 2);
  EXPECT_NEAR(result.truth.back().distance_m, 2.0 * length + 10.0, 1.0);
}

TEST(ReceiverTruth, OfACarThatStandsGoesNowhereForAllItsNoise) {
  std::vector<gnss_t> fixes;
  for (int i = 0; i < 600; ++i) {
    fixes.push_back(FixAt(kStart + 100'000 * i, 5.0));
    fixes.back().position_enu_m[0] += 0.01 * (i % 3 - 1);
    fixes.back().position_enu_m[1] += 0.01 * (i % 5 - 2);
  }
  EXPECT_NEAR(TruthOf(fixes).truth.back().distance_m, 0.0, 0.03);
}

TEST(ReceiverTruth, OfNoFixesIsNone) {
  const ReceiverTruth result = TruthOf({});
  EXPECT_TRUE(result.truth.empty());
  EXPECT_TRUE(result.gaps.empty());
}

TEST(ReceiverTruth, TakesTheAntennaOfTheCar) {
  const ReceiverTruthParams params =
      LoadReceiverTruthParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "truth"));
  EXPECT_EQ(params.antenna, Eigen::Vector2d(-0.3, 0.0));
  EXPECT_GT(params.max_position_sigma, 0.0);
}

}  // namespace
}  // namespace hairpin
