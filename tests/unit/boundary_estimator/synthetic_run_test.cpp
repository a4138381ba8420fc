#include "tests/unit/boundary_estimator/synthetic_run.hpp"

#include <gmock/gmock.h>

#include <iostream>
#include <numeric>

#include "tests/unit/boundary_estimator/shipped_params.hpp"

namespace hairpin {
namespace {

constexpr double kHairpinCurvature = 1.0 / 2.9;  // 9 m outside diameter, 3.2 m wide
constexpr double kHalfTurn = std::numbers::pi / kHairpinCurvature;

// Straights, sweepers and a chicane.
test::SyntheticTrack FlowingTrack() {
  return test::MakeLane({{30.0},
                         {25.0, 0.06},
                         {10.0},
                         {8.0, -0.15},
                         {8.0, 0.15},
                         {8.0, -0.15},
                         {20.0},
                         {30.0, -0.08},
                         {25.0}});
}

// Stretches that run back beside each other, 3.3 m from boundary to boundary, joined by hairpins;
// the last is the tightest.
test::SyntheticTrack FoldedTrack() {
  constexpr double kWide = 1.0 / 3.25;
  constexpr double kHalfWideTurn = std::numbers::pi / kWide;
  return test::MakeLane({{28.0},
                         {kHalfWideTurn, kWide},
                         {20.0},
                         {kHalfWideTurn, -kWide},
                         {34.0},
                         {kHalfTurn, kHairpinCurvature},
                         {40.0}});
}

struct Rates {
  int paths = 0;
  double full_length_percent = 0.0;
  double out_within_4m_percent = 0.0;
  double worst_metre_percent =
      0.0;  // share of the paths that leave the track at one and the same metre
};

Rates Measure(const test::SyntheticTrack& track, const test::SensorCharacter& character,
              double slide) {
  constexpr unsigned kRuns = 8;
  std::vector<int> left_at(16, 0);
  Rates rates;
  int full = 0;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    const test::SyntheticResult result =
        test::DriveAlong(track, test::ShippedParams(), character, slide, seed);
    rates.paths += result.paths;
    full += result.full_length;
    for (size_t i = 0; i < left_at.size(); ++i) left_at[i] += result.left_at[i];
  }
  const auto percent = [&](int count) { return 100.0 * count / rates.paths; };
  rates.full_length_percent = percent(full);
  rates.out_within_4m_percent = percent(std::accumulate(left_at.begin(), left_at.begin() + 4, 0));
  rates.worst_metre_percent = percent(*std::max_element(left_at.begin(), left_at.end()));
  std::cout << "paths " << rates.paths << ", full length " << rates.full_length_percent
            << " %, out within 4 m " << rates.out_within_4m_percent << " %, worst metre "
            << rates.worst_metre_percent << " %\n";
  return rates;
}

// Bounds below are the measured rates with a margin of a third or more: 0.35, 1.15, 0.17 and 0.96 %
// at the worst metre.
constexpr double kAlignedSlide = 0.15;  // rad
constexpr double kLargeSlide = 0.5;

TEST(SyntheticRun, StaysInsideAFlowingTrack) {
  const Rates rates = Measure(FlowingTrack(), {}, kAlignedSlide);
  EXPECT_GE(rates.full_length_percent, 95.0);
  EXPECT_EQ(rates.out_within_4m_percent, 0.0);
  EXPECT_LE(rates.worst_metre_percent, 0.6);
}

TEST(SyntheticRun, StaysInsideFoldedStretchesAndHairpins) {
  const Rates rates = Measure(FoldedTrack(), {}, kAlignedSlide);
  EXPECT_GE(rates.full_length_percent, 95.0);
  EXPECT_EQ(rates.out_within_4m_percent, 0.0);
  EXPECT_LE(rates.worst_metre_percent, 1.6);
}

TEST(SyntheticRun, StaysInsideWhileSliding) {
  const Rates rates = Measure(FlowingTrack(), {}, kLargeSlide);
  EXPECT_GE(rates.full_length_percent, 95.0);
  EXPECT_EQ(rates.out_within_4m_percent, 0.0);
  EXPECT_LE(rates.worst_metre_percent, 0.6);
}

TEST(SyntheticRun, StaysInsideWithPoorColours) {
  const Rates rates = Measure(
      FlowingTrack(), {.wrong_colour_near = 0.15, .wrong_colour_far = 0.15, .unknown_share = 0.5},
      kAlignedSlide);
  EXPECT_GE(rates.full_length_percent, 95.0);
  EXPECT_LE(rates.out_within_4m_percent, 0.3);
  EXPECT_LE(rates.worst_metre_percent, 1.5);
}

TEST(SyntheticRun, IsRepeatable) {
  const auto once = [] {
    return test::DriveAlong(FlowingTrack(), test::ShippedParams(), {}, kAlignedSlide, 3);
  };
  const test::SyntheticResult first = once(), second = once();
  EXPECT_EQ(first.full_length, second.full_length);
  EXPECT_EQ(first.worst, second.worst);
}

}  // namespace
}  // namespace hairpin
