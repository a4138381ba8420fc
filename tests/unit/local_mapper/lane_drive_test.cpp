#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/clock.hpp"
#include "daemons/local_mapper/conversion.hpp"
#include "daemons/local_mapper/local_mapper.hpp"
#include "daemons/local_mapper/local_mapper_node.hpp"
#include "tests/support/lane_world.hpp"

// Drives of 300 m along a winding lane with the parameters as shipped, each map judged against the
// truth.

namespace hairpin {
namespace {

using test::LaneWorld;

constexpr double kBelieved = 0.5;    // existence from which on a planner uses a cone
constexpr double kCertain = 0.8;     // not reached at first sight
constexpr double kNearRange = 13.0;  // m, where recall is high
constexpr double kBehindAxle = 3.0;  // m ahead of base begins what is judged as missed
constexpr int kWellObserved = 5;     // times

/// What the maps of a drive held, ahead of the car; all but the first are counts of cones over all
/// maps.
struct Verdict {
  int maps = 0;
  int believed = 0;
  int uncertain_extra = 0;  // neither a true cone's only match nor certain
  int doubled = 0;          // certain, but the true cone there has another match
  int phantoms = 0;         // certain, but no true cone is near
  int due = 0;              // well observed true cones, near and ahead
  int missed = 0;           // of those not in the map
  int well_observed = 0;    // seen in this very set, too
  int colour_right = 0;     // of those
  double squared_error = 0.0;
  double max_phantom_age = 0.0;  // s since a phantom, certain and near, was last seen

  double Rmse() const { return std::sqrt(squared_error / well_observed); }
  double ColourAccuracy() const { return static_cast<double>(colour_right) / well_observed; }
};

class LaneDrive {
 public:
  /// `same_cone`: how far [m] a cone of the map may be off its true cone.
  LaneDrive(MapMode mode, uint64_t seed, double same_cone)
      : mapper_(LoadLocalMapperParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "local_mapper"))),
        world_({.seed = seed}),
        same_cone_(same_cone) {
    mapper_.SetMode(mode);
  }

  Verdict Run() {
    while (world_.Step()) {
      mapper_.AddVelocity(world_.utime(), world_.velocity());
      for (const LaneWorld::Scan& scan : world_.TakeScans()) {
        const auto outcome = mapper_.Observe(*ToObservationSet(scan.pipeline, scan.message).set);
        if (!outcome.map) continue;
        for (const int cone : scan.true_index) ++times_seen_[cone];
        Judge(*outcome.map, scan.T_world_base);
      }
    }
    return verdict_;
  }

 private:
  struct Pair {
    double distance;
    size_t cone;  // of the map
    size_t truth;
  };

  void Judge(const LocalMapEstimate& map, const Pose2& T_world_base) {
    std::vector<LocalCone> cones;  // believed and ahead, positions in base
    const Pose2 T_base_local = map.T_local_base.Inverse();
    for (LocalCone cone : map.cones) {
      cone.position = T_base_local * cone.position;
      if (cone.existence >= kBelieved && cone.position.x() > 0.0) cones.push_back(cone);
    }
    std::vector<Eigen::Vector2d> truths;  // in base
    for (const auto& cone : world_.cones())
      truths.push_back(T_world_base.Inverse() * cone.position);
    ++verdict_.maps;
    verdict_.believed += static_cast<int>(cones.size());

    const std::vector<Pair> pairs = PairsByDistance(cones, truths);
    std::set<size_t> matched;
    std::set<size_t> found;
    for (const Pair& pair : pairs) {
      if (matched.contains(pair.cone) || found.contains(pair.truth)) continue;
      matched.insert(pair.cone);
      found.insert(pair.truth);
      JudgeMatch(cones[pair.cone], pair, map.utime);
    }
    for (size_t c = 0; c < cones.size(); ++c) {
      const bool near =
          std::any_of(pairs.begin(), pairs.end(), [c](const Pair& p) { return p.cone == c; });
      if (!matched.contains(c)) JudgeExtra(cones[c], near, map.utime);
    }
    CountMissed(found, truths);
  }

  std::vector<Pair> PairsByDistance(const std::vector<LocalCone>& cones,
                                    const std::vector<Eigen::Vector2d>& truths) const {
    std::vector<Pair> pairs;
    for (size_t c = 0; c < cones.size(); ++c) {
      for (size_t t = 0; t < truths.size(); ++t) {
        const double distance = (cones[c].position - truths[t]).norm();
        if (distance < same_cone_) pairs.push_back({distance, c, t});
      }
    }
    std::sort(pairs.begin(), pairs.end(),
              [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
    return pairs;
  }

  void JudgeMatch(const LocalCone& cone, const Pair& pair, int64_t utime) {
    if (cone.num_observations < kWellObserved || cone.last_seen_utime != utime) return;
    ++verdict_.well_observed;
    verdict_.squared_error += pair.distance * pair.distance;
    verdict_.colour_right += MostProbable(cone.colour) == world_.cones()[pair.truth].colour;
  }

  void JudgeExtra(const LocalCone& cone, bool near_a_cone, int64_t utime) {
    if (cone.existence < kCertain) {
      ++verdict_.uncertain_extra;
      return;
    }
    ++(near_a_cone ? verdict_.doubled : verdict_.phantoms);
    if (!near_a_cone && cone.position.norm() < kNearRange && cone.position.x() > kBehindAxle) {
      verdict_.max_phantom_age =
          std::max(verdict_.max_phantom_age, SecondsBetween(cone.last_seen_utime, utime));
    }
  }

  void CountMissed(const std::set<size_t>& found, const std::vector<Eigen::Vector2d>& truths) {
    for (const auto& [index, times] : times_seen_) {
      if (index < 0 || times < kWellObserved) continue;
      const auto truth = static_cast<size_t>(index);
      if (truths[truth].x() < kBehindAxle || truths[truth].norm() > kNearRange) continue;
      ++verdict_.due;
      verdict_.missed += !found.contains(truth);
    }
  }

  LocalMapper mapper_;
  LaneWorld world_;
  double same_cone_;
  std::map<int, int> times_seen_;  // by index of the true cone
  Verdict verdict_;
};

struct Expected {
  MapMode mode;
  double same_cone;  // m
  double rmse;       // m
  double colour_accuracy;
  double doubled_share;  // of the cones believed
  double phantom_share;
  double missed_share;  // of the cones due
};

class LaneDriveTest : public testing::TestWithParam<Expected> {};

TEST_P(LaneDriveTest, MapsTheLaneWithoutDoublesPhantomsOrGaps) {
  const Expected& expected = GetParam();
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(std::string(NameOf(expected.mode)) + ", seed " + std::to_string(seed));
    const Verdict verdict = LaneDrive(expected.mode, seed, expected.same_cone).Run();
    ASSERT_GT(verdict.maps, 200);
    ASSERT_GT(verdict.due, 1000);
    ASSERT_GT(verdict.well_observed, 1000);
    EXPECT_LT(verdict.Rmse(), expected.rmse);
    EXPECT_GT(verdict.ColourAccuracy(), expected.colour_accuracy);
    EXPECT_LE(verdict.doubled, expected.doubled_share * verdict.believed);
    EXPECT_LE(verdict.phantoms, expected.phantom_share * verdict.believed);
    EXPECT_LE(verdict.missed, expected.missed_share * verdict.due);
    EXPECT_LT(verdict.max_phantom_age, 0.5);
    EXPECT_LT(verdict.uncertain_extra, 0.03 * verdict.believed);
    std::cout << NameOf(expected.mode) << " seed " << seed << ": maps " << verdict.maps << ", rmse "
              << verdict.Rmse() << " m, colour " << verdict.ColourAccuracy() << ", believed "
              << verdict.believed << ", doubled " << verdict.doubled << ", phantoms "
              << verdict.phantoms << ", uncertain extras " << verdict.uncertain_extra << ", missed "
              << verdict.missed << " of " << verdict.due << '\n';
  }
}

INSTANTIATE_TEST_SUITE_P(
    EveryMode, LaneDriveTest,
    testing::Values(Expected{MapMode::kFusion, 1.0, 0.10, 0.99, 0.0, 0.0, 0.002},
                    Expected{MapMode::kLidarAndCamera, 1.0, 0.10, 0.98, 0.001, 0.002, 0.003},
                    Expected{MapMode::kLidarOnly, 1.0, 0.10, 0.88, 0.0, 0.0, 0.002},
                    // A single sighting is off by 0.05 * range in depth.
                    Expected{MapMode::kCameraOnly, 1.5, 0.20, 0.99, 0.006, 0.003, 0.01}),
    [](const auto& each) { return std::string(NameOf(each.param.mode)); });

}  // namespace
}  // namespace hairpin
