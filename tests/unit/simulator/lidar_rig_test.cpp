#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/oval_track.hpp"
#include "tests/support/simulator_setup.hpp"
#include "tools/simulator/lidar/centre_drive.hpp"
#include "tools/simulator/lidar/cone_shape.hpp"
#include "tools/simulator/simulator.hpp"
#include "tools/simulator/track_geometry.hpp"

namespace hairpin {
namespace {

using Bytes = std::vector<uint8_t>;

struct Wire {
  std::map<std::string, std::vector<Bytes>> data;
  std::map<std::string, std::vector<Bytes>> position;
  std::map<std::string, std::vector<FiringSequence>> sequences;
};

LidarRigParams LevelWorld() {
  LidarRigParams params = ShippedSimulatorParams().lidars;
  params.world.terrain.max_slope = 0.0;
  params.world.terrain.bump_height_m = 0.0;
  return params;
}

// `ticks` of 10 ms along the oval at 5 m/s.
Wire Drive(const LidarRigParams& params, uint64_t seed, int ticks, const std::string& off = "") {
  const Track track = OvalTrack();
  Wire wire;
  LidarRig rig(params, ShippedCar(), track, seed, Simulator::kFirstUtime,
               [&](const std::string& sensor, LidarRig::Port port, std::span<const uint8_t> bytes) {
                 auto& port_of = port == LidarRig::Port::kData ? wire.data : wire.position;
                 port_of[sensor].emplace_back(bytes.begin(), bytes.end());
               });
  rig.OnSequence([&](const std::string& sensor, const FiringSequence& sequence) {
    wire.sequences[sensor].push_back(sequence);
  });
  if (!off.empty()) rig.SetSource(off, false);
  const CentreDrive drive(track, 5.0);
  for (int tick = 0; tick <= ticks; ++tick) {
    rig.Advance(Simulator::kFirstUtime + 10'000 * tick, drive.At(0.01 * tick), AllCones(track));
  }
  return wire;
}

TEST(LidarRig, FiresEverySequenceOnceAndPacksTwelveIntoAPacket) {
  const Wire wire = Drive(LevelWorld(), 1, 20);
  for (const std::string& sensor : LidarRig::Sources()) {
    const auto& sequences = wire.sequences.at(sensor);
    ASSERT_NEAR(static_cast<double>(sequences.size()), 0.2 / 55.296e-6, 1.0);
    for (size_t i = 0; i < sequences.size(); ++i)
      ASSERT_EQ(sequences[i].start_ns, static_cast<int64_t>(i) * 55'296);
    EXPECT_EQ(wire.data.at(sensor).size(), sequences.size() / 12);
    EXPECT_EQ(wire.data.at(sensor)[0].size(), 1206u);
    EXPECT_EQ(wire.position.at(sensor)[0].size(), 512u);
  }
}

TEST(LidarRig, WithTheSameSeedSendsTheSameBytes) {
  EXPECT_EQ(Drive(LevelWorld(), 3, 5).data, Drive(LevelWorld(), 3, 5).data);
  EXPECT_NE(Drive(LevelWorld(), 3, 5).data, Drive(LevelWorld(), 4, 5).data);
}

TEST(LidarRig, ASensorThatIsOffLeavesTheOthersBytesAsTheyWere) {
  const Wire both = Drive(LevelWorld(), 1, 5);
  const Wire one = Drive(LevelWorld(), 1, 5, "lidar_front");
  EXPECT_FALSE(one.data.contains("lidar_front"));
  EXPECT_FALSE(one.position.contains("lidar_front"));
  EXPECT_EQ(one.data.at("lidar_top"), both.data.at("lidar_top"));
}

TEST(LidarRig, RefusesTimeThatDoesNotAdvanceAndUnknownSensors) {
  const Track track = OvalTrack();
  LidarRig rig(LevelWorld(), ShippedCar(), track, 1, 0,
               [](const std::string&, LidarRig::Port, std::span<const uint8_t>) {});
  rig.Advance(10'000, {}, AllCones(track));
  EXPECT_THROW(rig.Advance(10'000, {}, AllCones(track)), std::invalid_argument);
  EXPECT_THROW(rig.SetSource("lidar_rear", false), std::invalid_argument);
}

TEST(LidarScene, AConeThatWasKnockedDownIsSeenThrough) {
  const Track track = OvalTrack();
  LidarRig rig(LevelWorld(), ShippedCar(), track, 1, 0,
               [](const std::string&, LidarRig::Port, std::span<const uint8_t>) {});
  std::map<int, int> returns;
  rig.OnSequence([&](const std::string&, const FiringSequence& sequence) {
    for (const LidarReturn& echo : sequence.returns) ++returns[echo.cone];
  });
  const VehicleState state = CentreDrive(track, 5.0).At(0.0);
  std::vector<TrackCone> standing = AllCones(track);
  for (int tick = 0; tick <= 10; ++tick) rig.Advance(10'000 * tick, state, standing);
  const auto most = std::max_element(returns.begin(), returns.end(), [](auto& a, auto& b) {
    return a.first < 0 || (b.first >= 0 && a.second < b.second);
  });
  const int cone = most->first;
  ASSERT_GE(cone, 0);
  ASSERT_GT(most->second, 20);
  standing.erase(standing.begin() + cone);
  returns.clear();
  for (int tick = 11; tick <= 20; ++tick) rig.Advance(10'000 * tick, state, standing);
  EXPECT_EQ(returns[cone], 0);
}

TEST(CentreDrive, HasTheVelocityThatItsPosesSay) {
  const CentreDrive drive(LoadTrack(HAIRPIN_SOURCE_DIR "/config/tracks/default.yaml"), 8.0);
  constexpr double kTick = 0.01;
  // As a detector would deskew a revolution by it.
  for (int start = 0; start < 2000; start += 3) {
    Pose2 integrated = drive.At(kTick * start).T_map_base;
    for (int tick = start; tick < start + 10; ++tick)
      integrated = integrated * Integrate(drive.At(kTick * tick).velocity, kTick);
    const Pose2 pose = drive.At(kTick * (start + 10)).T_map_base;
    ASSERT_NEAR((integrated.position() - pose.position()).norm(), 0.0, 0.015) << start;
    ASSERT_NEAR(WrapAngle(integrated.yaw - pose.yaw), 0.0, 0.015) << start;
  }
}

TEST(ConeShape, StripesAreBrightOnBlueAndDarkOnYellow) {
  const Materials materials = ShippedSimulatorParams().lidars.world.materials;
  const auto reflectivity = [&](ConeColour colour, double height) {
    return SurfaceOf(materials, ConeMaterialAt(colour, height)).reflectivity;
  };
  for (const double edge : {0.05, 0.30}) {
    EXPECT_GT(reflectivity(ConeColour::kBlue, 0.18), 2.0 * reflectivity(ConeColour::kBlue, edge));
    EXPECT_LT(reflectivity(ConeColour::kYellow, 0.18),
              0.5 * reflectivity(ConeColour::kYellow, edge));
  }
}

TEST(ConeShape, HasTheRulesMeasures) {
  for (const auto& [colour, width, height] :
       {std::tuple{ConeColour::kBlue, 0.228f, 0.325f},
        std::tuple{ConeColour::kOrangeLarge, 0.285f, 0.505f}}) {
    const TriangleMesh mesh = ConeMesh(colour, Eigen::Isometry3d::Identity());
    Eigen::Vector3f low = mesh.vertices[0];
    Eigen::Vector3f high = low;
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      low = low.cwiseMin(vertex);
      high = high.cwiseMax(vertex);
    }
    EXPECT_TRUE((high - low).isApprox(Eigen::Vector3f(width, width, height), 1e-5f));
  }
}

TEST(RayScene, HitsABoxWhereItStandsAndNotOnceItIsTakenAway) {
  RayScene scene;
  TriangleMesh box;
  AddBox(Upright({5.0, 0.0, 0.0}, 0.0), {2.0, 2.0, 2.0}, box);
  const uint32_t id = scene.Add(box);
  scene.Commit();
  BeamDirections directions;
  directions.fill(Eigen::Vector3f(1.0f, 0.0f, 0.0f));
  directions[5] = Eigen::Vector3f(0.0f, 1.0f, 0.0f);
  const BeamHits hits = scene.Cast({0.0f, 0.3f, 0.2f}, directions, 100.0f);
  EXPECT_NEAR(hits[0].range, 4.0f, 1e-5f);
  EXPECT_EQ(hits[0].mesh, id);
  EXPECT_NEAR(hits[0].cosine, 1.0f, 1e-6f);
  EXPECT_FALSE(std::isfinite(hits[5].range));
  EXPECT_FALSE(std::isfinite(scene.Cast({0.0f, 0.3f, 0.2f}, directions, 3.0f)[0].range));
  scene.Enable(id, false);
  scene.Commit();
  EXPECT_FALSE(std::isfinite(scene.Cast({0.0f, 0.3f, 0.2f}, directions, 100.0f)[0].range));
}

}  // namespace
}  // namespace hairpin
