#include "daemons/lidar_cone_detector/clustering.hpp"

#include <gmock/gmock.h>

#include <numeric>
#include <random>
#include <set>

namespace hairpin {
namespace {

using Partition = std::set<std::set<uint32_t>>;

Partition PartitionOf(const Clusters& clusters) {
  Partition partition;
  for (size_t k = 0; k < clusters.size(); ++k)
    partition.emplace(clusters[k].begin(), clusters[k].end());
  return partition;
}

// Every pair compared, labels spread until nothing changes.
Partition Naive(const std::vector<float>& x, const std::vector<float>& y, float tolerance) {
  std::vector<uint32_t> label(x.size());
  std::iota(label.begin(), label.end(), 0u);
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t i = 0; i < x.size(); ++i) {
      for (size_t j = 0; j < i; ++j) {
        const float dx = x[i] - x[j], dy = y[i] - y[j];
        if (dx * dx + dy * dy > tolerance * tolerance || label[i] == label[j]) continue;
        label[i] = label[j] = std::min(label[i], label[j]);
        changed = true;
      }
    }
  }
  std::map<uint32_t, std::set<uint32_t>> groups;
  for (size_t i = 0; i < x.size(); ++i) groups[label[i]].insert(static_cast<uint32_t>(i));
  Partition partition;
  for (const auto& [first, group] : groups) partition.insert(group);
  return partition;
}

TEST(Clustering, EqualsThePairwiseDefinitionOnRandomPoints) {
  Clustering clustering(0.25, 10.0);
  for (uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> where(-3.0f, 3.0f);
    std::vector<float> x(400), y(400);
    for (size_t i = 0; i < x.size(); ++i) {
      x[i] = where(random);
      y[i] = where(random);
    }
    std::vector<uint32_t> all(x.size());
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(PartitionOf(clustering.Run(x, y, all)), Naive(x, y, 0.25f)) << "seed " << seed;
  }
}

TEST(Clustering, LeavesOutWhatWasNotSelectedAndWhatLiesOutside) {
  Clustering clustering(0.25, 10.0);
  const std::vector<float> x{0.0f, 0.1f, 11.0f, 5.0f}, y{0.0f, 0.0f, 0.0f, -10.0f};
  const std::vector<uint32_t> selected{0, 2, 3};
  EXPECT_EQ(PartitionOf(clustering.Run(x, y, selected)), (Partition{{0}, {3}}));
}

TEST(Clustering, NumbersClustersByTheirFirstPoint) {
  Clustering clustering(0.25, 10.0);
  const std::vector<float> x{5.0f, -5.0f, 5.1f}, y{5.0f, -5.0f, 5.0f};
  const std::vector<uint32_t> all{0, 1, 2};
  const Clusters& clusters = clustering.Run(x, y, all);
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_THAT(std::vector<uint32_t>(clusters[0].begin(), clusters[0].end()),
              testing::ElementsAre(0, 2));
}

TEST(Clustering, RefusesParametersThatCannotBe) {
  EXPECT_THROW(Clustering(0.0, 10.0), std::invalid_argument);
  EXPECT_THROW(Clustering(0.2, 0.0), std::invalid_argument);
  EXPECT_THROW(Clustering(0.001, 100.0), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
