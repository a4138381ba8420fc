#include "tools/simulator/track_ordering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tools/simulator/random.hpp"
#include "tools/simulator/track_generator.hpp"
#include "tools/simulator/track_geometry.hpp"

namespace hairpin {
namespace {

TEST(TrackOrdering, FindsTheOrderOfShuffledSidesOfRandomTracks) {
  constexpr uint64_t kSeeds = 20;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Polyline side = PositionsOf(GenerateTrack({seed, std::nullopt, 0}).left);
    std::vector<size_t> shuffled(side.size());
    std::iota(shuffled.begin(), shuffled.end(), size_t{0});
    RandomStream random(seed);
    for (size_t i = shuffled.size() - 1; i > 0; --i)
      std::swap(shuffled[i], shuffled[random.Index(i + 1)]);
    Polyline points;
    for (const size_t i : shuffled) points.push_back(side[i]);
    const std::vector<size_t> order = OrderAlongClosedCurve(points);
    ASSERT_EQ(order.size(), side.size());
    EXPECT_EQ(order[0], 0u);
    const size_t n = side.size();
    size_t breaks = 0;
    for (size_t i = 0; i < n; ++i) {
      const size_t step = (shuffled[order[(i + 1) % n]] + n - shuffled[order[i]]) % n;
      if (step != 1 && step != n - 1) ++breaks;
    }
    EXPECT_EQ(breaks, 0u) << "seed " << seed;
  }
}

TEST(TrackOrdering, FewPointsHaveOnlyOneOrder) {
  EXPECT_TRUE(OrderAlongClosedCurve({}).empty());
  EXPECT_EQ(OrderAlongClosedCurve({{0, 0}, {1, 0}, {0, 1}}), (std::vector<size_t>{0, 1, 2}));
}

}  // namespace
}  // namespace hairpin
