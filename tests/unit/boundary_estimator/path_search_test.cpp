#include "daemons/boundary_estimator/path_search.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <numeric>
#include <random>
#include <set>

#include "tests/unit/boundary_estimator/shipped_params.hpp"

namespace hairpin {
namespace {

// A lane along x with jittered cones and random colours, and some cones beside it.
Scene RandomScene(unsigned seed, int pairs) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.6, 0.6), share(0.0, 1.0);
  Scene scene;
  const auto add = [&](double x, double y) {
    scene.ids.push_back(static_cast<int64_t>(scene.ids.size()) + 1);
    scene.positions.emplace_back(x + jitter(random), y + jitter(random));
    const double blue = share(random), yellow = (1.0 - blue) * share(random);
    scene.ratios.push_back(ToSideLogRatios({1.0 - blue - yellow, blue, yellow, 0.0, 0.0}, 0.01));
  };
  for (int i = 0; i < pairs; ++i) {
    add(3.5 * i - 2.0, 1.7);
    add(3.5 * i - 1.0, -1.7);
    if (i % 2 == 1) add(3.5 * i, 5.0);
  }
  return scene;
}

double Deviation(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

// The score of a path from its definition, all cones in the product, nothing incremental.
double NaiveLogPosterior(const Scene& scene, const std::vector<CrossedEdge>& edges,
                         const PathScoreParams& params) {
  const auto at = [&](int i) { return scene.positions[static_cast<size_t>(i)]; };
  std::vector<double> left, right, width;
  Eigen::Vector2d end(0.0, 0.0), anchor(0.0, 0.0);
  double length = 0.0, largest = 0.0, heading = 0.0;
  for (size_t i = 0; i < edges.size(); ++i) {
    const Eigen::Vector2d middle = 0.5 * (at(edges[i].left) + at(edges[i].right));
    length += (middle - end).norm();
    end = middle;
    if ((middle - anchor).norm() >= params.min_segment) {
      const double next = std::atan2(middle.y() - anchor.y(), middle.x() - anchor.x());
      largest = std::max(largest, std::abs(WrapAngle(next - heading)));
      heading = next;
      anchor = middle;
    }
    if (i == 0) continue;
    const CrossedEdge before = edges[i - 1];
    const bool on_left = edges[i].left != before.left;
    const Eigen::Vector2d from = at(on_left ? before.left : before.right),
                          to = at(on_left ? edges[i].left : edges[i].right);
    const double spacing = (to - from).norm();
    if (spacing >= params.min_spacing) (on_left ? left : right).push_back(spacing);
    width.push_back(DistanceToSegment(at(on_left ? edges[i].right : edges[i].left), from, to));
  }
  std::set<int> lefts, rights;
  for (const CrossedEdge& edge : edges) {
    lefts.insert(edge.left);
    rights.insert(edge.right);
  }
  double log_likelihood = 0.0;
  for (const int cone : lefts) log_likelihood += scene.ratios[static_cast<size_t>(cone)].left;
  for (const int cone : rights) log_likelihood += scene.ratios[static_cast<size_t>(cone)].right;
  const FeatureValues features{largest,
                               Deviation(left),
                               Deviation(right),
                               Deviation(width),
                               static_cast<double>(edges.size()),
                               length};
  return Score(features, log_likelihood, params).log_posterior();
}

// No edge is too wide here, so that every path begins with a gate.
PathSearchParams NarrowParams() {
  PathSearchParams params = test::ShippedParams().search;
  params.max_width = 100.0;
  params.max_spacing = 100.0;
  return params;
}

TEST(PathSearch, ScoresAsTheNaiveComputationDoes) {
  const PathScoreParams score = test::ShippedParams().score;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Scene scene = RandomScene(seed, 7);
    PathSearch search(NarrowParams(), score);
    const PathSearchResult result = search.Search(scene, Triangulate(scene.positions));
    ASSERT_TRUE(result.winner && result.runner_up) << seed;
    for (const ScoredPath* path : {&*result.winner, &*result.runner_up}) {
      EXPECT_NEAR(path->score.log_posterior(), NaiveLogPosterior(scene, path->edges, score), 1e-9)
          << seed;
    }
    EXPECT_GE(result.winner->score.log_posterior(), result.runner_up->score.log_posterior());
  }
}

// Every path there is, by plain recursion over the triangles.
class Enumeration {
 public:
  Enumeration(const Scene& scene, const Triangulation& triangulation,
              const PathSearchParams& params, const PathScoreParams& score)
      : scene_(scene), triangulation_(triangulation), params_(params), score_(score) {}

  void From(std::vector<CrossedEdge> path, std::set<int> cones, std::set<int> triangles, int next) {
    ++count;
    best = std::max(best, NaiveLogPosterior(scene_, path, score_));
    if (next == Triangulation::kOutside || !triangles.insert(next).second) return;
    if (static_cast<int>(path.size()) >= params_.max_edges || Length(path) > params_.horizon)
      return;
    const auto [vertex, neighbour] = triangulation_.triangles[static_cast<size_t>(next)];
    const CrossedEdge edge = path.back();
    for (size_t i = 0; i < 3; ++i) {
      if (vertex[i] == edge.left || vertex[i] == edge.right) continue;
      if (!cones.insert(vertex[i]).second) return;
      for (size_t k = 0; k < 3; ++k) {
        if (k == i) continue;
        const bool leaves_left = vertex[k] == edge.left;
        path.push_back(leaves_left ? CrossedEdge{vertex[i], edge.right}
                                   : CrossedEdge{edge.left, vertex[i]});
        if (Admissible(path)) From(path, cones, triangles, neighbour[k]);
        path.pop_back();
      }
    }
  }

  bool Admissible(const std::vector<CrossedEdge>& path) const {
    const Eigen::Vector2d across = At(path.back().left) - At(path.back().right);
    if (across.norm() < params_.min_width) return false;
    PathFeatures features({0.0, 0.0}, {1.0, 0.0});
    for (const CrossedEdge& edge : path)
      features.Cross(0.5 * (At(edge.left) + At(edge.right)), score_.min_segment);
    return features.values()[0] <= params_.max_turn + 1e-12;
  }

  double best = -1e300;
  int count = 0;

 private:
  Eigen::Vector2d At(int i) const { return scene_.positions[static_cast<size_t>(i)]; }
  double Length(const std::vector<CrossedEdge>& path) const {
    PathFeatures features({0.0, 0.0}, {1.0, 0.0});
    for (const CrossedEdge& edge : path)
      features.Cross(0.5 * (At(edge.left) + At(edge.right)), score_.min_segment);
    return features.length();
  }

  const Scene& scene_;
  const Triangulation& triangulation_;
  const PathSearchParams& params_;
  const PathScoreParams& score_;
};

TEST(PathSearch, WithAWideBeamFindsWhatEnumerationFinds) {
  PathSearchParams params = NarrowParams();
  params.beam_width = 1000;
  const PathScoreParams score = test::ShippedParams().score;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Scene scene = RandomScene(seed, 4);
    const Triangulation triangulation = Triangulate(scene.positions);
    Enumeration enumeration(scene, triangulation, params, score);
    for (size_t t = 0; t < triangulation.triangles.size(); ++t) {
      const auto [vertex, neighbour] = triangulation.triangles[t];
      const auto side = [&](size_t i) {
        const Eigen::Vector2d a = scene.positions[static_cast<size_t>(vertex[(i + 1) % 3])];
        const Eigen::Vector2d b = scene.positions[static_cast<size_t>(vertex[(i + 2) % 3])];
        return a.x() * b.y() - a.y() * b.x();
      };
      if (side(0) < 0.0 || side(1) < 0.0 || side(2) < 0.0) continue;
      for (size_t i = 0; i < 3; ++i) {
        const std::vector<CrossedEdge> root{{vertex[(i + 2) % 3], vertex[(i + 1) % 3]}};
        if (!enumeration.Admissible(root)) continue;
        enumeration.From(root, {root[0].left, root[0].right}, {static_cast<int>(t)}, neighbour[i]);
      }
    }
    PathSearch search(params, score);
    const PathSearchResult result = search.Search(scene, triangulation);
    ASSERT_TRUE(result.winner) << seed;
    EXPECT_GT(enumeration.count, 20) << seed;
    EXPECT_EQ(result.num_candidates, enumeration.count) << seed;
    EXPECT_NEAR(result.winner->score.log_posterior(), enumeration.best, 1e-9) << seed;
  }
}

TEST(PathSearch, HasNoConeTwiceAndMovesOneSideAtATime) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Scene scene = RandomScene(seed, 8);
    PathSearch search(test::ShippedParams().search, test::ShippedParams().score);
    const PathSearchResult result = search.Search(scene, Triangulate(scene.positions));
    ASSERT_TRUE(result.winner) << seed;
    std::set<int> cones{result.winner->edges[0].left, result.winner->edges[0].right};
    for (size_t i = 1; i < result.winner->edges.size(); ++i) {
      const CrossedEdge before = result.winner->edges[i - 1], edge = result.winner->edges[i];
      ASSERT_NE(edge.left == before.left, edge.right == before.right) << seed;
      EXPECT_TRUE(cones.insert(edge.left == before.left ? edge.right : edge.left).second) << seed;
    }
  }
}

TEST(PathSearch, RunnerUpNeitherBeginsNorContinuesTheWinner) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Scene scene = RandomScene(seed, 7);
    PathSearch search(test::ShippedParams().search, test::ShippedParams().score);
    const PathSearchResult result = search.Search(scene, Triangulate(scene.positions));
    ASSERT_TRUE(result.winner && result.runner_up) << seed;
    const size_t common = std::min(result.winner->edges.size(), result.runner_up->edges.size());
    EXPECT_FALSE(std::equal(result.winner->edges.begin(),
                            result.winner->edges.begin() + static_cast<std::ptrdiff_t>(common),
                            result.runner_up->edges.begin()));
  }
}

TEST(PathSearch, FindsNothingWithoutTriangles) {
  PathSearch search(test::ShippedParams().search, test::ShippedParams().score);
  const PathSearchResult result = search.Search({}, {});
  EXPECT_FALSE(result.winner);
  EXPECT_EQ(result.num_candidates, 0);
}

TEST(PathSearch, RefusesMoreConesThanItHasRoomFor) {
  Scene scene;
  scene.positions.resize(PathSearch::kMaxCones + 1);
  scene.ratios.resize(PathSearch::kMaxCones + 1);
  PathSearch search(test::ShippedParams().search, test::ShippedParams().score);
  EXPECT_THROW(search.Search(scene, {}), std::invalid_argument);
}

TEST(PathSearchParams, AreRefusedOutOfRange) {
  const auto refused = [](const std::function<void(PathSearchParams&)>& spoil) {
    PathSearchParams params = test::ShippedParams().search;
    spoil(params);
    EXPECT_THROW(PathSearch(params, test::ShippedParams().score), std::invalid_argument);
  };
  refused([](auto& p) { p.beam_width = 0; });
  refused([](auto& p) { p.max_edges = 0; });
  refused([](auto& p) { p.horizon = 0.0; });
  refused([](auto& p) { p.min_width = 0.0; });
  refused([](auto& p) { p.max_width = p.min_width; });
  refused([](auto& p) { p.max_spacing = 0.0; });
  refused([](auto& p) { p.max_turn = 4.0; });
}

}  // namespace
}  // namespace hairpin
