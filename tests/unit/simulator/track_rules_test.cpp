#include <gmock/gmock.h>

#include <numbers>

#include "tests/unit/simulator/track_testing.hpp"
#include "tools/simulator/track_checks.hpp"
#include "tools/simulator/track_generator.hpp"

namespace hairpin {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Two straights and two half circles, driven counter-clockwise from mid-straight, cones `spacing`
/// apart at most.
struct Oval {
  double straight = 60.0;
  double radius = 15.0;  // of the centre line
  double width = 3.5;
  double spacing = 3.5;

  Track Make() const {
    Track track;
    const double half = 0.5 * width;
    track.start = {-6.0, 0.0, 0.0};
    track.start_line = {{0.0, half}, {0.0, -half}};
    track.finish_line = track.start_line;
    track.left = Side(half, ConeColour::kBlue);
    track.right = Side(-half, ConeColour::kYellow);
    return track;
  }

  std::vector<TrackCone> Side(double offset, ConeColour colour) const {
    const double bend = std::numbers::pi * (radius - offset);
    const double length = 2.0 * straight + 2.0 * bend;
    constexpr double kGate = 1.0;
    const auto steps = static_cast<size_t>(std::ceil((length - 2.0 * kGate) / spacing));
    std::vector<TrackCone> side;
    for (size_t i = 0; i <= steps; ++i) {
      const double station =
          kGate + (length - 2.0 * kGate) * static_cast<double>(i) / static_cast<double>(steps);
      side.push_back(
          {At(station, offset, bend), i == 0 || i == steps ? ConeColour::kOrangeLarge : colour});
    }
    return side;
  }

  Eigen::Vector2d At(double station, double offset, double bend) const {
    double left = station - 0.5 * straight;
    if (left < 0.0) return {station, offset};
    const bool second = left >= bend + straight;  // half of the lap
    if (second) left -= bend + straight;
    const double r = radius - offset;
    const double angle = std::min(left, bend) / r - 0.5 * std::numbers::pi;
    Eigen::Vector2d point(0.5 * straight + r * std::cos(angle), radius + r * std::sin(angle));
    if (left > bend) point.x() -= left - bend;
    if (second) point = Eigen::Vector2d(0.0, 2.0 * radius) - point;
    return point;
  }
};

std::vector<std::string> RulesBrokenBy(const Oval& oval) { return CheckRules(oval.Make()); }

TEST(TrackRules, ALegalOvalHasNoViolations) {
  const Track track = Oval().Make();
  EXPECT_FALSE(FindProblem(track).has_value());
  EXPECT_THAT(CheckRules(track), IsEmpty());
}

TEST(TrackRules, WidthBelowThreeMetresIsTold) {
  EXPECT_THAT(RulesBrokenBy({.width = 2.8}), ElementsAre(HasSubstr("m wide")));
}

TEST(TrackRules, ConesFurtherApartThanFiveMetresAreTold) {
  EXPECT_THAT(RulesBrokenBy({.spacing = 5.4}),
              ElementsAre(HasSubstr("left side: 38 gaps of more than 5.00 m, the widest 5.3"),
                          HasSubstr("right side: 42 gaps of more than 5.00 m, the widest 5.3")));
}

TEST(TrackRules, ConesMustBeCloserInCorners) {
  EXPECT_THAT(RulesBrokenBy({.straight = 78.0, .radius = 9.0, .spacing = 4.8}),
              Contains(HasSubstr("gaps in corners of more than 4.00 m")));
  EXPECT_THAT(RulesBrokenBy({.straight = 78.0, .radius = 9.0, .spacing = 3.9}), IsEmpty());
}

TEST(TrackRules, StraightsBeyondEightyMetresAreTold) {
  EXPECT_THAT(RulesBrokenBy({.straight = 90.0}), ElementsAre(HasSubstr("longer than 80 m")));
}

TEST(TrackRules, LapsMustBeOfTwoToFiveHundredMetres) {
  EXPECT_THAT(RulesBrokenBy({.straight = 40.0}), ElementsAre(HasSubstr("shorter than 200 m")));
  EXPECT_THAT(RulesBrokenBy({.straight = 70.0, .radius = 60.0}),
              Contains(HasSubstr("longer than 500 m")));
}

TEST(TrackRules, TurnsWiderThanFiftyMetresAreTold) {
  EXPECT_THAT(RulesBrokenBy({.radius = 22.0}), IsEmpty());
  const auto broken = RulesBrokenBy({.radius = 26.0});
  ASSERT_FALSE(broken.empty());
  EXPECT_THAT(broken, Each(AllOf(HasSubstr("a turn of 55."), HasSubstr("more than 50 m"))));
}

TEST(TrackRules, HairpinsTighterThanNineMetresOutsideAreTold) {
  EXPECT_THAT(RulesBrokenBy({.radius = 2.4, .width = 3.2, .spacing = 1.5}),
              Contains(HasSubstr("less than 9 m")));
  EXPECT_THAT(RulesBrokenBy({.radius = 3.2, .width = 3.2, .spacing = 1.5}),
              Not(Contains(HasSubstr("less than 9 m"))));
}

TEST(TrackRules, StretchesMustKeepApart) {
  EXPECT_THAT(RulesBrokenBy({.radius = 3.0}), Contains(HasSubstr("two stretches come within 2.")));
  EXPECT_THAT(RulesBrokenBy({.radius = 3.6}), Not(Contains(HasSubstr("two stretches"))));
}

TEST(TrackRules, AGateOfFourLargeOrangeConesIsAsked) {
  Track track = Oval().Make();
  track.right.front().colour = ConeColour::kYellow;
  EXPECT_THAT(CheckRules(track), ElementsAre(HasSubstr("2 on the left, 1 on the right")));
}

TEST(TrackRules, TheCarWaitsSixMetresBeforeTheLineOnAStraight) {
  Track track = Oval().Make();
  track.start.x = -12.0;
  EXPECT_THAT(CheckRules(track), ElementsAre(HasSubstr("waits 12.00 m before the start line")));
  track.start = {-6.0, 0.0, 0.2};
  EXPECT_THAT(CheckRules(track), ElementsAre(HasSubstr("not on a straight")));
}

}  // namespace
}  // namespace hairpin
