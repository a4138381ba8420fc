#include "daemons/lidar_cone_detector/lidar_cone_detector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hairpin {
namespace {

// Gathered about a centre that was only guessed: a return this far off the fitted surface is not
// the cone's.
constexpr float kOffSurface = 0.10f;
// One piece shown to be a part of more shows it of its neighbour in turn; so many in a row.
constexpr int kPasses = 4;

float MeanRadius(const ConeBody& shape) {
  return static_cast<float>(0.5 * (shape.foot_radius + shape.top_radius));
}

}  // namespace

LidarConeDetector::LidarConeDetector(const LidarConeDetectorParams& params)
    : params_(params),
      ground_(params.ground),
      clustering_(params.cluster_tolerance, params.max_range),
      feet_(params.foot_radius, params.max_range + 1.0),
      surroundings_(params.surroundings, params.max_range + 1.0) {}

void LidarConeDetector::SelectObstacles(const PointCloud& cloud) {
  const auto low = static_cast<float>(params_.ground_band);
  const auto high = static_cast<float>(params_.max_height);
  const std::vector<float>& heights = *heights_;
  obstacles_.resize(cloud.size());
  size_t count = 0;
  for (size_t i = 0; i < cloud.size(); ++i) {
    obstacles_[count] = static_cast<uint32_t>(i);
    count += static_cast<size_t>(heights[i] > low) & static_cast<size_t>(heights[i] < high);
  }
  obstacles_.resize(count);
}

void LidarConeDetector::FindCentres(const PointCloud& cloud, const Clusters& clusters) {
  centres_.clear();
  const auto extent = static_cast<float>(params_.max_cluster_extent);
  for (size_t k = 0; k < clusters.size(); ++k) {
    Eigen::Vector2f low = Eigen::Vector2f::Constant(std::numeric_limits<float>::max());
    Eigen::Vector2f high = -low;
    Eigen::Vector2f sum = Eigen::Vector2f::Zero();
    for (const uint32_t i : clusters[k]) {
      const Eigen::Vector2f position(cloud.x[i], cloud.y[i]);
      low = low.cwiseMin(position);
      high = high.cwiseMax(position);
      sum += position;
    }
    const Eigen::Vector2f mean = sum / static_cast<float>(clusters[k].size());
    if (((high - low).array() > extent).any()) continue;
    if (mean.squaredNorm() > static_cast<float>(params_.max_range * params_.max_range)) continue;
    const Eigen::Vector2f sensor =
        sensors_[cloud.sensor[clusters[k].front()]].T_base_sensor.translation().head<2>();
    const float behind = 0.25f * std::numbers::pi_v<float> * MeanRadius(params_.small_cone);
    centres_.push_back(mean + behind * (mean - sensor).normalized());
  }
}

void LidarConeDetector::Examine(const PointCloud& cloud, std::span<const uint32_t> points) {
  if (points.empty()) return;
  const std::vector<float>& heights = *heights_;
  const auto band = static_cast<float>(params_.ground_band);
  float top = 0.0f;
  for (const uint32_t i : points) top = std::max(top, heights[i]);
  const bool large = top > static_cast<float>(params_.small_cone.height) + kOffSurface;
  const ConeBody& shape = large ? params_.large_cone : params_.small_cone;
  returns_.clear();
  for (const uint32_t i : points) {
    if (heights[i] > band) returns_.push_back({{cloud.x[i], cloud.y[i]}, heights[i]});
  }
  if (returns_.empty()) return;
  const Eigen::Vector2f sensor =
      sensors_[cloud.sensor[points.front()]].T_base_sensor.translation().head<2>();
  const ConeFit fit = FitCone(returns_, sensor, shape, params_.fit);

  members_.clear();
  ConeEvidence evidence;
  evidence.residual = fit.residual;
  evidence.height = static_cast<float>(shape.height);
  for (const uint32_t i : points) {
    const float off =
        (Eigen::Vector2f(cloud.x[i], cloud.y[i]) - fit.axis).norm() - shape.RadiusAt(heights[i]);
    if (off > kOffSurface) continue;
    members_.push_back(i);
    if (heights[i] <= band) continue;
    ++evidence.returns;
    evidence.top = std::max(evidence.top, heights[i]);
  }
  const float ground = ground_.HeightAt(fit.axis.x(), fit.axis.y());
  evidence.expected = model_.Expect(fit.axis.x(), fit.axis.y(), ground, shape, band);
  const Verdict verdict = Judge(evidence, params_.acceptance);
  candidates_.push_back({fit.axis, evidence.returns, verdict});
  if (verdict == Verdict::kCone) AddCone(fit, evidence, large);
}

void LidarConeDetector::AddCone(const ConeFit& fit, const ConeEvidence& evidence, bool large) {
  DetectedCone& cone = cones_.emplace_back();
  cone.position = fit.axis;
  cone.covariance = Covariance(fit.axis, static_cast<float>(evidence.returns));
  cone.large = large;
  cone.points = members_;
  cone.returns = evidence.returns;
  cone.top = evidence.top;
  cone.expected = evidence.expected.most;
}

Eigen::Matrix2f LidarConeDetector::Covariance(const Eigen::Vector2f& axis, float returns) const {
  const float range = axis.norm();
  float step = std::numbers::pi_v<float>;
  for (const SensorGeometry& sensor : sensors_) step = std::min(step, sensor.azimuth_step);
  const auto squared = [](double value) { return static_cast<float>(value * value); };
  const float floor = squared(params_.covariance.floor_sigma);
  const float along = floor + squared(params_.fit.range_sigma) / returns;
  // A firing falls anywhere within its step: a uniform distribution's variance.
  const float across = floor + range * range * step * step / (12.0f * returns) +
                       range * range * squared(params_.covariance.bearing_sigma);
  const Eigen::Vector2f u = axis.normalized();
  const Eigen::Vector2f v(-u.y(), u.x());
  return along * u * u.transpose() + across * v * v.transpose();
}

bool LidarConeDetector::RemovePartsOfMore(const PointCloud& cloud) {
  standing_.clear();
  for (const DetectedCone& cone : cones_) {
    const size_t sensor = cloud.sensor[cone.points.front()];
    standing_.push_back(
        {cone.position, sensors_[sensor].T_base_sensor.translation().head<2>(), cone.top});
  }
  const std::vector<bool>& free = surroundings_.StandFree(cloud, *heights_, standing_);
  size_t kept = 0, number = 0;  // of the accepted ones
  for (Candidate& candidate : candidates_) {
    if (candidate.verdict != Verdict::kCone) continue;
    if (free[number]) {
      if (kept != number) cones_[kept] = std::move(cones_[number]);
      ++kept;
    } else {
      candidate.verdict = Verdict::kPartOfMore;
    }
    ++number;
  }
  cones_.resize(kept);
  return kept < number;
}

void LidarConeDetector::RemoveDoubles() {
  // The better seen one of a pair stays.
  std::stable_sort(cones_.begin(), cones_.end(), [](const DetectedCone& a, const DetectedCone& b) {
    return a.returns > b.returns;
  });
  const auto nearest = static_cast<float>(params_.min_distance * params_.min_distance);
  std::vector<DetectedCone> kept;
  for (DetectedCone& cone : cones_) {
    const bool is_double = std::any_of(kept.begin(), kept.end(), [&](const DetectedCone& other) {
      return (other.position - cone.position).squaredNorm() < nearest;
    });
    if (!is_double) kept.push_back(std::move(cone));
  }
  std::stable_sort(kept.begin(), kept.end(), [](const DetectedCone& a, const DetectedCone& b) {
    return a.position.squaredNorm() < b.position.squaredNorm();
  });
  if (kept.size() > static_cast<size_t>(params_.max_cones))
    kept.resize(static_cast<size_t>(params_.max_cones));
  cones_ = std::move(kept);
}

const std::vector<DetectedCone>& LidarConeDetector::Detect(
    const PointCloud& cloud, std::span<const SensorGeometry> sensors) {
  Done(DetectorStage::kStart);
  sensors_ = sensors;
  model_.SetSensors(sensors);
  heights_ = &ground_.Fit(cloud);
  Done(DetectorStage::kGround);
  SelectObstacles(cloud);
  const Clusters& clusters = clustering_.Run(cloud.x, cloud.y, obstacles_);
  Done(DetectorStage::kClusters);
  FindCentres(cloud, clusters);
  const Clusters& feet =
      feet_.Run(cloud, *heights_, centres_, static_cast<float>(params_.foot_height),
                static_cast<float>(params_.max_height));
  Done(DetectorStage::kFeet);
  cones_.clear();
  candidates_.clear();
  for (size_t k = 0; k < feet.size(); ++k) Examine(cloud, feet[k]);
  for (int pass = 0; pass < kPasses && RemovePartsOfMore(cloud); ++pass) continue;
  RemoveDoubles();
  Done(DetectorStage::kCones);
  return cones_;
}

}  // namespace hairpin
