#include <gtest/gtest.h>

#include "tests/support/oval_track.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/track_area.hpp"

namespace hairpin {
namespace {

Track Mirrored(Track track) {
  std::swap(track.left, track.right);
  for (auto* cones : {&track.left, &track.right}) {
    for (TrackCone& cone : *cones) cone.position.y() *= -1.0;
  }
  return track;
}

Track Turned(Track track, const Pose2& T_to_from) {
  for (auto* cones : {&track.left, &track.right}) {
    for (TrackCone& cone : *cones) cone.position = T_to_from * cone.position;
  }
  return track;
}

// Even-odd over all edges of one loop.
bool InLoop(const std::vector<TrackCone>& loop, const Eigen::Vector2d& p) {
  bool inside = false;
  for (size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector2d& a = loop[i].position;
    const Eigen::Vector2d& b = loop[(i + 1) % loop.size()].position;
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
  }
  return inside;
}

TEST(TrackArea, HoldsTheMiddleOfTheTrackAndNothingBesideIt) {
  const TrackArea area(OvalTrack());
  for (double s = 0.0; s < OvalLength(); s += 0.5) {
    EXPECT_TRUE(area.Contains(OvalPose(s).position()));
    EXPECT_TRUE(area.Contains(OvalPose(s) * Eigen::Vector2d(0.0, 1.4)));
    EXPECT_FALSE(area.Contains(OvalPose(s) * Eigen::Vector2d(0.0, 2.0)));
    EXPECT_FALSE(area.Contains(OvalPose(s) * Eigen::Vector2d(0.0, -2.0)));
  }
  EXPECT_FALSE(area.Contains({0.0, 12.0}));
  EXPECT_FALSE(area.Contains({1000.0, -1000.0}));
  EXPECT_FALSE(area.Contains({std::nan(""), std::nan("")}));
}

TEST(TrackArea, EqualsTheNaiveTestOfBothLoops) {
  const Track track = Turned(OvalTrack(), {5.0, -7.0, 0.8});
  const TrackArea area(track);
  RandomStream random(1, "points");
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector2d p(random.Uniform(-50.0, 50.0), random.Uniform(-50.0, 50.0));
    EXPECT_EQ(area.Contains(p), InLoop(track.left, p) != InLoop(track.right, p));
  }
}

TEST(TrackArea, MirrorsWithTheTrack) {
  const TrackArea area(OvalTrack());
  const TrackArea mirrored(Mirrored(OvalTrack()));
  RandomStream random(2, "points");
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d p(random.Uniform(-50.0, 50.0), random.Uniform(-10.0, 40.0));
    EXPECT_EQ(area.Contains(p), mirrored.Contains({p.x(), -p.y()}));
  }
}

TEST(TrackArea, ProlongsAnOpenTrackByItsRunOff) {
  Track track;
  track.closed = false;
  track.left = {{{0.0, 1.5}, ConeColour::kBlue}, {{10.0, 1.5}, ConeColour::kBlue}};
  track.right = {{{0.0, -1.5}, ConeColour::kYellow}, {{10.0, -1.5}, ConeColour::kYellow}};
  const TrackArea area(track);
  EXPECT_TRUE(area.Contains({5.0, 0.0}));
  EXPECT_TRUE(area.Contains({-30.0, 1.0}));
  EXPECT_TRUE(area.Contains({40.0, -1.0}));
  EXPECT_FALSE(area.Contains({-40.0, 0.0}));
  EXPECT_FALSE(area.Contains({50.0, 0.0}));
  EXPECT_FALSE(area.Contains({5.0, 2.0}));
}

TEST(TrackArea, RefusesATrackWithoutTwoBoundaries) {
  Track track = OvalTrack();
  track.right.resize(2);
  EXPECT_THROW(TrackArea{track}, std::invalid_argument);
}

TEST(CrossGate, KnowsItsDirectionAndItsPlace) {
  const GateLine line{{0.0, 1.0}, {0.0, -1.0}};
  const GateCrossing forward = CrossGate(line, {-1.0, 0.5}, {3.0, 0.5});
  EXPECT_EQ(forward.direction, 1);
  EXPECT_NEAR(forward.share, 0.25, 1e-12);
  EXPECT_EQ(CrossGate(line, {3.0, 0.5}, {-1.0, 0.5}).direction, -1);
  EXPECT_EQ(CrossGate(line, {-1.0, 1.5}, {3.0, 1.5}).direction, 0);
  EXPECT_EQ(CrossGate(line, {-1.0, 0.0}, {-0.1, 0.0}).direction, 0);
}

TEST(CrossGate, CountsAStopOnTheLineOnce) {
  const GateLine line{{0.0, 1.0}, {0.0, -1.0}};
  EXPECT_EQ(CrossGate(line, {-1.0, 0.0}, {0.0, 0.0}).direction +
                CrossGate(line, {0.0, 0.0}, {1.0, 0.0}).direction,
            1);
}

}  // namespace
}  // namespace hairpin
