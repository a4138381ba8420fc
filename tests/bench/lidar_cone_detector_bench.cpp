// The detector and its stages on one scan of 57,600 points, and PCL's plane and clusters on the
// same.
#include <benchmark/benchmark.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <iostream>

#include "daemons/lidar_cone_detector/lidar_cone_detector_node.hpp"
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

// 32 rings x 1800 firings; walls so high that every beam returns.
const LabelledCloud& Hall() {
  static const LabelledCloud scan = [] {
    LidarWorld world = LaneBetweenWalls(20);
    for (LidarWorld::Wall& wall : world.walls) wall.height = 50.0f;
    world.slope_y = 0.01f;
    return Scan(world, Sensor(), 0.02f, 100.0f, 1);
  }();
  return scan;
}

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
