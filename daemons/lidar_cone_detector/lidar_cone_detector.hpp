#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "daemons/lidar_cone_detector/acceptance.hpp"
#include "daemons/lidar_cone_detector/clustering.hpp"
#include "daemons/lidar_cone_detector/cone_body.hpp"
#include "daemons/lidar_cone_detector/cone_fit.hpp"
#include "daemons/lidar_cone_detector/expected_returns.hpp"
#include "daemons/lidar_cone_detector/foot_reconstruction.hpp"
#include "daemons/lidar_cone_detector/ground.hpp"
#include "daemons/lidar_cone_detector/point_cloud.hpp"
#include "daemons/lidar_cone_detector/surroundings.hpp"

namespace hairpin {

struct CovarianceParams {
  double floor_sigma = 0.0;    // what no number of returns takes away: mounts, shape [m]
  double bearing_sigma = 0.0;  // mount and time stamps, across the line of sight [rad]
};

struct LidarConeDetectorParams {
  GroundParams ground;
  double ground_band = 0.0;         // points below this height are ground [m]
  double max_height = 0.0;          // points above take no part [m]
  double max_range = 0.0;           // of cones, from base [m]
  double cluster_tolerance = 0.0;   // [m]
  double max_cluster_extent = 0.0;  // a wider cluster is no cone [m]
  double foot_radius = 0.0;         // of the cylinder for the foot [m]
  double foot_height = 0.0;         // its lower end above the ground: the plate is flat ground [m]
  ConeBody small_cone, large_cone;
  ConeFitParams fit;
  AcceptanceParams acceptance;
  SurroundingsParams surroundings;
  double min_distance = 0.0;  // nearer detections are one [m]
  CovarianceParams covariance;
  int max_cones = 0;  // in one scan, nearest first
};

/// A cone in base at the cloud's time.
struct DetectedCone {
  Eigen::Vector2f position = Eigen::Vector2f::Zero();    // of its axis [m]
  Eigen::Matrix2f covariance = Eigen::Matrix2f::Zero();  // [m^2]
  bool large = false;                                    // stands higher than a small cone can
  std::vector<uint32_t> points;  // its returns, foot included: indices into the cloud
  int returns = 0;               // above the ground's band
  float top = 0.0f;              // height of the highest [m]
  float expected = 0.0f;         // to the sensor that sees it best
};

/// A cluster that was looked at, for pictures and figures.
struct Candidate {
  Eigen::Vector2f position;
  int returns;
  Verdict verdict;
};

enum class DetectorStage { kStart, kGround, kClusters, kFeet, kCones };
inline constexpr int kNumDetectorStages = 4;  // kStart is none

/// LiDAR points to cones [paper III-B, "LiDAR only"]: adaptive ground removal, Euclidean clusters,
/// reconstruction of the foot, a cone's surface fitted, acceptance by the expected number of
/// returns and by room about it. Keeps its buffers from call to call.
class LidarConeDetector {
 public:
  /// Throws std::invalid_argument where a parameter cannot be.
  explicit LidarConeDetector(const LidarConeDetectorParams& params);

  /// Cones by rising range. `sensors`: where the points' sensor indices lead. The result lives
  /// until the next call.
  const std::vector<DetectedCone>& Detect(const PointCloud& cloud,
                                          std::span<const SensorGeometry> sensors);
  /// Height of every point of the last cloud above the ground [m].
  const std::vector<float>& heights() const { return *heights_; }
  const Ground& ground() const { return ground_; }
  const std::vector<Candidate>& candidates() const { return candidates_; }

  /// Is called at the start and at the end of each stage of Detect(), for a stopwatch.
  void OnStageDone(std::function<void(DetectorStage)> listener) { listener_ = std::move(listener); }

 private:
  void SelectObstacles(const PointCloud& cloud);
  void FindCentres(const PointCloud& cloud, const Clusters& clusters);
  void Examine(const PointCloud& cloud, std::span<const uint32_t> points);
  void AddCone(const ConeFit& fit, const ConeEvidence& evidence, bool large);
  Eigen::Matrix2f Covariance(const Eigen::Vector2f& axis, float returns) const;
  /// True if any was removed.
  bool RemovePartsOfMore(const PointCloud& cloud);
  void RemoveDoubles();
  void Done(DetectorStage stage) const {
    if (listener_) listener_(stage);
  }

  LidarConeDetectorParams params_;
  Ground ground_;
  Clustering clustering_;
  FootReconstruction feet_;
  ReturnModel model_;
  Surroundings surroundings_;
  std::span<const SensorGeometry> sensors_;
  const std::vector<float>* heights_ = nullptr;
  std::vector<uint32_t> obstacles_;
  std::vector<Eigen::Vector2f> centres_;
  std::vector<ConeReturn> returns_;  // of the candidate in work
  std::vector<uint32_t> members_;
  std::vector<Candidate> candidates_;
  std::vector<Surroundings::Standing> standing_;
  std::vector<DetectedCone> cones_;
  std::function<void(DetectorStage)> listener_;
};

}  // namespace hairpin
