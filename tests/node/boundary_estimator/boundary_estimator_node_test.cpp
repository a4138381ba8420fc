#include "daemons/boundary_estimator/boundary_estimator_node.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace hairpin {
namespace {

constexpr int64_t kStart = 1'700'000'000'000'000;

local_cone_t Cone(int64_t id, double x, double y, ConeColour colour) {
  local_cone_t cone{};
  cone.id = id;
  cone.x_m = x;
  cone.y_m = y;
  cone.covariance_xx_m2 = cone.covariance_yy_m2 = 0.01;
  cone.probability[static_cast<size_t>(colour)] = 1.0F;
  cone.existence = 0.9F;
  return cone;
}

// A straight lane along x, the car at its begin.
local_map_t Lane(int64_t utime) {
  local_map_t map{};
  map.utime = utime;
  map.epoch = 42;
  map.x_m = 1.0;
  for (int i = 0; i < 6; ++i) {
    map.cones.push_back(Cone(2 * i + 1, 4.0 * i, 1.6, ConeColour::kBlue));
    map.cones.push_back(Cone(2 * i + 2, 4.0 * i + 0.5, -1.6, ConeColour::kYellow));
  }
  map.num_cones = static_cast<int32_t>(map.cones.size());
  return map;
}

class BoundaryEstimatorNodeTest : public testing::Test {
 protected:
  BoundaryEstimatorNodeTest() {
    tester_.Subscribe(channels::kTrack,
                      [this](const track_t& message) { tracks_.push_back(message); });
  }

  void Send(const local_map_t& map) {
    tester_.Publish(channels::kLocalMap, map);
    transport_.Drain();
  }

  int64_t refused() const { return bus_.Health().at(0).refused; }

  Transport transport_{"memq://"};
  Bus bus_{transport_, "boundary_estimator", 1};
  Bus tester_{transport_, "tester", 2};
  BoundaryEstimatorNode node_{
      LoadBoundaryEstimatorParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "boundary_estimator")),
      bus_};
  std::vector<track_t> tracks_;
};

TEST_F(BoundaryEstimatorNodeTest, AnswersALocalMapWithATrack) {
  Send(Lane(kStart));
  ASSERT_EQ(tracks_.size(), 1U);
  const track_t& track = tracks_[0];
  EXPECT_EQ(track.utime, kStart);
  EXPECT_EQ(track.epoch, 42);
  EXPECT_EQ(track.x_m, 1.0);
  EXPECT_TRUE(track.valid);
  EXPECT_EQ(track.fallback, track_t::FALLBACK_NONE);
  EXPECT_GT(track.seen_length_m, 15.0);
  EXPECT_GE(track.length_m, track.seen_length_m);
  EXPECT_EQ(track.num_points, static_cast<int32_t>(track.path.size()));
  EXPECT_EQ(track.path.front().x_m, 1.0);
  EXPECT_FALSE(track.path.front().extrapolated);
  for (const boundary_point_t& point : track.left) EXPECT_EQ(point.id % 2, 1);
  for (const boundary_point_t& point : track.right) EXPECT_EQ(point.id % 2, 0);
}

TEST_F(BoundaryEstimatorNodeTest, TellsWhyThePathWon) {
  Send(Lane(kStart));
  ASSERT_EQ(tracks_.size(), 1U);
  const track_t& track = tracks_[0];
  EXPECT_GT(track.num_candidates, 1);
  ASSERT_TRUE(track.has_runner_up);
  for (const path_score_t* score : {&track.winner, &track.runner_up}) {
    double cost = 0.0;
    for (const double term : score->term) cost += term;
    EXPECT_NEAR(score->log_prior, -29.0 * cost, 1e-9);
    EXPECT_NEAR(score->log_posterior, score->log_prior + score->log_likelihood, 1e-12);
  }
  EXPECT_GE(track.winner.log_posterior, track.runner_up.log_posterior);
}

TEST_F(BoundaryEstimatorNodeTest, SaysSoWhereThereIsNoPath) {
  local_map_t map = Lane(kStart);
  map.cones.clear();
  map.num_cones = 0;
  Send(map);
  ASSERT_EQ(tracks_.size(), 1U);
  EXPECT_FALSE(tracks_[0].valid);
  EXPECT_EQ(tracks_[0].num_points, 0);
  EXPECT_EQ(tracks_[0].length_m, 0.0);
}

TEST_F(BoundaryEstimatorNodeTest, LeavesDoubtfulConesOut) {
  local_map_t map = Lane(kStart);
  for (local_cone_t& cone : map.cones) cone.existence = 0.1F;
  Send(map);
  ASSERT_EQ(tracks_.size(), 1U);
  EXPECT_FALSE(tracks_[0].valid);
}

TEST_F(BoundaryEstimatorNodeTest, RefusesTimeGoingBack) {
  Send(Lane(kStart));
  Send(Lane(kStart - 100'000));
  Send(Lane(kStart));
  EXPECT_EQ(tracks_.size(), 1U);
  EXPECT_EQ(refused(), 2);
  Send(Lane(kStart + 100'000));
  EXPECT_EQ(tracks_.size(), 2U);
}

TEST_F(BoundaryEstimatorNodeTest, RefusesAMapWithAConeThatCannotBe) {
  const auto refuses = [&](auto spoil) {
    const int64_t before = refused();
    local_map_t map = Lane(kStart);
    spoil(map.cones[3]);
    Send(map);
    EXPECT_EQ(refused(), before + 1);
  };
  refuses([](local_cone_t& cone) { cone.covariance_xx_m2 = -0.01; });
  refuses([](local_cone_t& cone) { cone.covariance_xy_m2 = 0.02; });
  refuses([](local_cone_t& cone) { cone.probability[1] = -0.5F; });
  refuses([](local_cone_t& cone) { cone.probability[1] = 0.5F; });
  refuses([](local_cone_t& cone) { cone.existence = 1.5F; });
  refuses([](local_cone_t& cone) { cone.existence = -0.1F; });
  refuses([](local_cone_t& cone) { cone.x_m = 1e9; });
  refuses([](local_cone_t& cone) { cone.id = 1; });
  EXPECT_TRUE(tracks_.empty());
}

TEST_F(BoundaryEstimatorNodeTest, RefusesAPoseThatCannotBe) {
  local_map_t map = Lane(kStart);
  map.x_m = 1e9;
  Send(map);
  EXPECT_TRUE(tracks_.empty());
  EXPECT_EQ(refused(), 1);
}

TEST_F(BoundaryEstimatorNodeTest, SendsTheSameBytesForTheSameMaps) {
  std::vector<track_t> other_tracks;
  Transport transport("memq://");
  Bus bus(transport, "boundary_estimator", 1), tester(transport, "tester", 2);
  BoundaryEstimatorNode node(
      LoadBoundaryEstimatorParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "boundary_estimator")),
      bus);
  tester.Subscribe(channels::kTrack,
                   [&](const track_t& message) { other_tracks.push_back(message); });
  for (int i = 0; i < 5; ++i) {
    local_map_t map = Lane(kStart + 100'000 * i);
    map.x_m += 0.7 * i;
    Send(map);
    tester.Publish(channels::kLocalMap, map);
    transport.Drain();
  }
  ASSERT_EQ(tracks_.size(), other_tracks.size());
  for (size_t i = 0; i < tracks_.size(); ++i) {
    const auto bytes = [](const track_t& track) {
      std::vector<uint8_t> buffer(static_cast<size_t>(track.getEncodedSize()));
      track.encode(buffer.data(), 0, static_cast<int>(buffer.size()));
      return buffer;
    };
    EXPECT_EQ(bytes(tracks_[i]), bytes(other_tracks[i]));
  }
}

TEST(BoundaryEstimatorConfig, RefusesWhatItDoesNotKnow) {
  const auto load = [](const std::vector<std::string>& overrides) {
    return LoadBoundaryEstimatorParams(
        Config::Load(HAIRPIN_SOURCE_DIR "/config", "boundary_estimator", overrides));
  };
  EXPECT_NO_THROW(load({}));
  EXPECT_THROW(load({"search.beam_width=0"}), ConfigError);
  EXPECT_THROW(load({"max_cones=1000"}), ConfigError);
  EXPECT_THROW(load({"prior.feature_weights=[0.1, 0.1]"}), ConfigError);
  EXPECT_THROW(load({"likelihood.min_probability=0.7"}), ConfigError);
  EXPECT_THROW(load({"path.extrapolation_m=nan"}), ConfigError);
}

}  // namespace
}  // namespace hairpin
