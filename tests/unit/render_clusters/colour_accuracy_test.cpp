// The shipped net on simulated cones that it has not learnt from.
#include <gtest/gtest.h>

#include <array>

#include "daemons/lidar_cone_detector/colour_classifier.hpp"
#include "tests/support/simulator_setup.hpp"
#include "tools/train/render_clusters.hpp"

namespace hairpin {
namespace {

constexpr std::array<double, 6> kBins{0.0, 5.0, 7.5, 10.0, 12.5, 15.0};  // [paper, Table I], m
constexpr std::array<double, 5> kWanted{0.88, 0.93, 0.89, 0.87, 0.80};

ColourClassifier ShippedClassifier() {
  return ColourClassifier(LoadColourParams(
      Config::Load(std::string(HAIRPIN_SOURCE_DIR) + "/config", "lidar_cone_detector")));
}

std::vector<LabelledCone> Cones(uint64_t first_seed, int scans) {
  const SimulatorParams params = ShippedSimulatorParams();
  std::vector<LabelledCone> cones;
  for (int scan = 0; scan < scans; ++scan) {
    for (LabelledCone& cone :
         RenderClusters(params.lidars, ShippedCar(), first_seed + static_cast<uint64_t>(scan))) {
      if (cone.returns.x.size() >= 3) cones.push_back(std::move(cone));
    }
  }
  return cones;
}

TEST(LidarColour, IsRightAsOftenAsInThePaperOnSensorsAndConesOfManyKinds) {
  const ColourClassifier classifier = ShippedClassifier();
  std::array<int, 5> count{};
  std::array<int, 5> right{};
  int wrong = 0;
  for (const LabelledCone& cone : Cones(9'000'000, 40)) {
    if (cone.colour != ConeColour::kBlue && cone.colour != ConeColour::kYellow) continue;
    const double range = cone.returns.axis.norm();
    for (size_t bin = 0; bin < count.size(); ++bin) {
      if (range < kBins[bin] || range >= kBins[bin + 1]) continue;
      const ConeColour said =
          MostProbable(classifier.Classify(std::span(&cone.returns, 1)).front());
      ++count[bin];
      right[bin] += said == cone.colour;
      wrong += said != cone.colour && said != ConeColour::kUnknown;
    }
  }
  int all = 0;
  for (size_t bin = 0; bin < count.size(); ++bin) {
    ASSERT_GT(count[bin], 60);
    EXPECT_GT(static_cast<double>(right[bin]) / count[bin], kWanted[bin]) << bin;
    all += count[bin];
  }
  EXPECT_LT(static_cast<double>(wrong) / all, 0.04);
}

TEST(LidarColour, RenderedWithTheSameSeedIsTheSame) {
  const SimulatorParams params = ShippedSimulatorParams();
  const auto once = RenderClusters(params.lidars, ShippedCar(), 3);
  const auto again = RenderClusters(params.lidars, ShippedCar(), 3);
  ASSERT_EQ(once.size(), again.size());
  for (size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].returns.z, again[i].returns.z);
    EXPECT_EQ(once[i].returns.intensity, again[i].returns.intensity);
  }
}

}  // namespace
}  // namespace hairpin
