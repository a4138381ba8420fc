#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cstdlib>
#include <filesystem>

#include "tests/unit/path_tracker/closed_loop.hpp"

namespace hairpin {
namespace {

using namespace test;

std::string DataFolder() {
  const char* folder = std::getenv("HAIRPIN_DATA");
  return folder ? folder : std::string(HAIRPIN_SOURCE_DIR) + "/../shared/data";
}

Points Side(const YAML::Node& track, const char* side) {
  Points points;
  for (const auto& cone : track[side]) {
    points.emplace_back(cone["position"][0].as<double>(), cone["position"][1].as<double>());
  }
  return points;
}

Eigen::Vector2d NearestOn(const Points& ring, const Eigen::Vector2d& point) {
  Eigen::Vector2d nearest = ring[0];
  for (size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i];
    const Eigen::Vector2d d = ring[(i + 1) % ring.size()] - a;
    const Eigen::Vector2d q = a + std::clamp((point - a).dot(d) / d.squaredNorm(), 0.0, 1.0) * d;
    if ((q - point).norm() < (nearest - point).norm()) nearest = q;
  }
  return nearest;
}

// A lap of the centreline as points 0.1 m apart: midpoints between each left cone and the right
// boundary, rounded off.
Points Centreline(const std::string& file) {
  const YAML::Node track = YAML::LoadFile(file)["track"];
  const Points left = Side(track, "left");
  const Points right = Side(track, "right");
  Points middle;
  for (const auto& cone : left) middle.push_back(0.5 * (cone + NearestOn(right, cone)));
  middle.push_back(middle.front());
  const ReferencePath smooth(middle, {0.1, 1.2, 1000.0});
  Points points;
  Eigen::Vector2d at = middle.front();
  double heading = smooth.Locate(at, 0.0, 0.2).heading;
  for (const double curvature : smooth.curvature()) {
    points.push_back(at);
    const Pose2 next = Pose2{at.x(), at.y(), heading} *
                       Integrate({smooth.spacing(), 0.0, smooth.spacing() * curvature}, 1.0);
    at = next.position();
    heading = next.yaw;
  }
  return points;
}

class RealTrack : public testing::TestWithParam<const char*> {};

TEST_P(RealTrack, IsDrivenAtSevenMetresPerSecondOrMoreWithTwelveMetresSeen) {
  const std::string file = DataFolder() + "/tracks/" + GetParam() + ".yaml";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
  LoopOptions options;
  options.seen_length = 12.0;
  options.noise = 0.1;
  options.path_point_spacing = 1.0;
  const Points centreline = Centreline(file);
  ClosedLoop loop(centreline, ShippedParams(), options);
  const Eigen::Vector2d along = centreline[5] - centreline[0];
  loop.plant.pose = {centreline[0].x(), centreline[0].y(), std::atan2(along.y(), along.x())};
  std::vector<LoopSample> samples;
  while (samples.empty() || (samples.back().s < loop.length() - 15.0 && samples.back().t < 90.0)) {
    samples.push_back(loop.Step());
  }
  EXPECT_GE(samples.back().s / samples.back().t, 7.0);
  EXPECT_LT(MaxAbsLateralError(samples), 0.35);
  EXPECT_LT(MaxSpeed(samples), 12.3);
}

INSTANTIATE_TEST_SUITE_P(Layouts, RealTrack,
                         testing::Values("FSG19", "FSG21", "FSE22", "FSO20", "FSS19", "FSS22_V1"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace hairpin
