// One scan of 57,600 points from its packets to cones; the detector and its stages on such a scan;
// PCL's plane and clusters on the same.
#include <benchmark/benchmark.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <chrono>
#include <iostream>

#include "daemons/lidar_cone_detector/lidar_cone_detector_node.hpp"
#include "daemons/lidar_driver/lidar_driver_node.hpp"
#include "tests/support/lidar_packets.hpp"
#include "tests/support/lidar_world.hpp"

namespace hairpin {
namespace {

const LidarConeDetectorParams& Params() {
  static const LidarConeDetectorParams params =
      LoadLidarConeDetectorParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "lidar_cone_detector"))
          .detector;
  return params;
}

const SensorGeometry& Sensor() {
  static const SensorGeometry sensor = UnevenSensor({1.25f, 0.0f, 0.35f}, 0.2f);
  return sensor;
}

// Walls so high that every beam returns.
LidarWorld HallWorld() {
  LidarWorld world = LaneBetweenWalls(20);
  for (LidarWorld::Wall& wall : world.walls) wall.height = 50.0f;
  world.slope_y = 0.01f;
  return world;
}

// 32 rings x 1800 firings.
const LabelledCloud& Hall() {
  static const LabelledCloud scan = Scan(HallWorld(), Sensor(), 0.02f, 100.0f, 1);
  return scan;
}

/// The front LiDAR's driver and the detector as they run on the car, with the bus between them, fed
/// with one revolution of packets after another.
class Chain {
 public:
  Chain() {
    observer_.Subscribe(channels::kConesLidar, [this](const cones_t& m) { cones_ = m; });
    detector_.OnStageDone([this](DetectorStage) { marks_.push_back(Now()); });
  }

  /// The sensor's clock and the car's velocity go on by a revolution.
  void Advance();
  /// The revolution's packets. The cones are those of the revolution before, which the first of
  /// them completes.
  void Turn() {
    start_ = Now();
    driver_.OnPacket({packets_.front(), kEpoch, {}});
    packed_ = Now();
    marks_.clear();
    transport_.Drain();
    published_ = Now();
    for (size_t i = 1; i < packets_.size(); ++i) driver_.OnPacket({packets_[i], kEpoch, {}});
    end_ = Now();
  }
  /// Of the last Turn() [ms].
  void Report(benchmark::UserCounters& counters) const {
    counters["decode_ms"] = end_ - published_;
    counters["pack_ms"] = packed_ - start_;
    if (marks_.size() != kNumDetectorStages + 1) return;  // the first
    counters["unpack_deskew_ms"] = marks_[0] - packed_;
    counters["ground_ms"] = marks_[1] - marks_[0];
    counters["clusters_ms"] = marks_[2] - marks_[1];
    counters["feet_ms"] = marks_[3] - marks_[2];
    counters["acceptance_ms"] = marks_[4] - marks_[3];
    counters["colours_ms"] = published_ - marks_[4];
    counters["points"] = static_cast<double>(detector_.cloud().size());
    counters["cones"] = static_cast<double>(cones_.cones.size());
  }

 private:
  static constexpr int64_t kEpoch = 1'700'000'000'000'000;
  static constexpr double kSpeed = 10.0;  // m/s

  static double Now() {
    const auto time = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(time).count();
  }

  LidarDriverNodeParams driver_params_ =
      LoadLidarDriverParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "lidar_driver",
                                         {"gnss_wait_s=0", "front.sensor_address=any"}),
                            "front");
  LidarConeDetectorNodeParams detector_params_ = LoadLidarConeDetectorParams(
      Config::Load(HAIRPIN_SOURCE_DIR "/config", "lidar_cone_detector"));
  std::vector<VelodyneDataPacket> packets_ =
      TurnPackets(HallWorld(), detector_params_.T_base_sensor[0],
                  driver_params_.driver.revolution.cut_azimuth, kSpeed, 0.015f, kEpoch);
  Transport transport_{"memq://"};
  Bus driver_bus_{transport_, "lidar_driver_front", 1};
  Bus detector_bus_{transport_, "lidar_cone_detector", 2};
  Bus car_{transport_, "velocity_estimator", 3};
  Bus observer_{transport_, "observer", 4};
  LidarDriverNode driver_{driver_params_, "front", driver_bus_};
  LidarConeDetectorNode detector_{detector_params_, detector_bus_};
  int64_t turns_ = 0;
  int64_t velocity_utime_ = kEpoch - 200'000;
  std::vector<double> marks_;
  double start_ = 0.0, packed_ = 0.0, published_ = 0.0, end_ = 0.0;
  cones_t cones_{};
};

void Chain::Advance() {
  const int64_t period_ns = Vlp32c().sequence_ns * kTurnSequences;
  for (size_t i = 0; i < packets_.size(); ++i) {
    const int64_t ns = (turns_ * kTurnPackets + static_cast<int64_t>(i)) * period_ns / kTurnPackets;
    const auto us = static_cast<uint32_t>(ns / 1000 % 3'600'000'000);
    for (size_t byte = 0; byte < 4; ++byte)
      packets_[i][1200 + byte] = static_cast<uint8_t>(us >> (8 * byte));
  }
  ++turns_;
  for (; velocity_utime_ < kEpoch + turns_ * period_ns / 1000 + 20'000; velocity_utime_ += 10'000) {
    velocity_t velocity{};
    velocity.utime = velocity_utime_;
    velocity.valid = 1;
    velocity.vx_mps = kSpeed;
    car_.Publish(channels::kVelocity, velocity);
  }
  transport_.Drain();
}

// All that the car does between the wire and CONES_LIDAR, once a scan: packets decoded, a
// revolution packed, published and unpacked, deskewed, ground, clusters, acceptance, colours, cones
// published.
void BM_PacketsToCones(benchmark::State& state) {
  static Chain chain;
  for (auto _ : state) {
    state.PauseTiming();
    chain.Advance();
    state.ResumeTiming();
    chain.Turn();
  }
  chain.Report(state.counters);
}
BENCHMARK(BM_PacketsToCones)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->Repetitions(101)
    ->ReportAggregatesOnly();

void BM_Detector(benchmark::State& state) {
  const LabelledCloud& scan = Hall();
  LidarConeDetector detector(Params());
  const std::vector<SensorGeometry> sensors{Sensor()};
  for (auto _ : state) benchmark::DoNotOptimize(detector.Detect(scan.cloud, sensors).size());

  double all = 0.0, kept = 0.0;
  for (const int hit : scan.hit) all += hit >= 0;
  for (const DetectedCone& cone : detector.Detect(scan.cloud, sensors)) {
    for (const uint32_t i : cone.points) kept += scan.hit[i] >= 0;
  }
  state.counters["points"] = static_cast<double>(scan.cloud.size());
  state.counters["cones"] = static_cast<double>(detector.Detect(scan.cloud, sensors).size());
  state.counters["cone_points"] = all;
  state.counters["cone_points_kept"] = kept;
}
BENCHMARK(BM_Detector)->Unit(benchmark::kMillisecond);

void BM_Ground(benchmark::State& state) {
  Ground ground(Params().ground);
  for (auto _ : state) benchmark::DoNotOptimize(ground.Fit(Hall().cloud).data());
}
BENCHMARK(BM_Ground)->Unit(benchmark::kMillisecond);

std::vector<uint32_t> Obstacles() {
  Ground ground(Params().ground);
  const std::vector<float>& heights = ground.Fit(Hall().cloud);
  std::vector<uint32_t> obstacles;
  for (uint32_t i = 0; i < heights.size(); ++i) {
    if (heights[i] > static_cast<float>(Params().ground_band) &&
        heights[i] < static_cast<float>(Params().max_height))
      obstacles.push_back(i);
  }
  return obstacles;
}

void BM_Clusters(benchmark::State& state) {
  const std::vector<uint32_t> obstacles = Obstacles();
  Clustering clustering(Params().cluster_tolerance, Params().max_range);
  const PointCloud& cloud = Hall().cloud;
  for (auto _ : state) benchmark::DoNotOptimize(clustering.Run(cloud.x, cloud.y, obstacles).size());
  state.counters["points"] = static_cast<double>(obstacles.size());
}
BENCHMARK(BM_Clusters)->Unit(benchmark::kMillisecond);

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

void BM_PclPlane(benchmark::State& state) {
  const PclCloud::Ptr cloud(new PclCloud);
  for (size_t i = 0; i < Hall().cloud.size(); ++i)
    cloud->emplace_back(Hall().cloud.x[i], Hall().cloud.y[i], Hall().cloud.z[i]);
  for (auto _ : state) {
    pcl::SACSegmentation<pcl::PointXYZ> plane;
    plane.setModelType(pcl::SACMODEL_PLANE);
    plane.setMethodType(pcl::SAC_RANSAC);
    plane.setMaxIterations(100);
    plane.setDistanceThreshold(Params().ground_band);
    plane.setInputCloud(cloud);
    pcl::PointIndices inliers;
    pcl::ModelCoefficients coefficients;
    plane.segment(inliers, coefficients);
    benchmark::DoNotOptimize(inliers.indices.size());
  }
}
BENCHMARK(BM_PclPlane)->Unit(benchmark::kMillisecond);

// In the plane, on the points that our ground removal leaves, as ours does: the same partition.
void BM_PclClusters(benchmark::State& state) {
  const std::vector<uint32_t> obstacles = Obstacles();
  const PclCloud::Ptr cloud(new PclCloud);
  const auto reach = static_cast<float>(Params().max_range);
  for (const uint32_t i : obstacles) {
    if (std::abs(Hall().cloud.x[i]) <= reach && std::abs(Hall().cloud.y[i]) <= reach)
      cloud->emplace_back(Hall().cloud.x[i], Hall().cloud.y[i], 0.0f);
  }
  std::vector<pcl::PointIndices> clusters;
  for (auto _ : state) {
    clusters.clear();
    const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
    tree->setInputCloud(cloud);
    pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
    extraction.setClusterTolerance(Params().cluster_tolerance);
    extraction.setMinClusterSize(1);
    extraction.setSearchMethod(tree);
    extraction.setInputCloud(cloud);
    extraction.extract(clusters);
  }
  Clustering ours(Params().cluster_tolerance, Params().max_range);
  state.counters["clusters"] = static_cast<double>(clusters.size());
  state.counters["clusters_ours"] =
      static_cast<double>(ours.Run(Hall().cloud.x, Hall().cloud.y, obstacles).size());
}
BENCHMARK(BM_PclClusters)->Unit(benchmark::kMillisecond);

// Colours of 30 cones of 30 returns each.
void BM_Colours(benchmark::State& state) {
  const ColourClassifier classifier({3, 1.0});
  std::vector<ConeReturns> cones(30);
  for (size_t i = 0; i < cones.size(); ++i) {
    cones[i].axis = {8.0f, 0.5f * static_cast<float>(i)};
    for (int k = 0; k < 30; ++k) {
      cones[i].x.push_back(cones[i].axis.x());
      cones[i].y.push_back(cones[i].axis.y() + 0.03f * static_cast<float>(k % 5 - 2));
      cones[i].z.push_back(0.05f * static_cast<float>(k / 5 + 1));
      cones[i].intensity.push_back(static_cast<uint8_t>(10 * (k / 5)));
    }
  }
  for (auto _ : state) benchmark::DoNotOptimize(classifier.Classify(cones));
}
BENCHMARK(BM_Colours)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hairpin
