#include "daemons/local_mapper/local_mapper.hpp"

#include <cmath>

#include "common/clock.hpp"
#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr Require require("local_mapper");

/// What trapezoidal integration over a gap may miss, where the rate's derivative changes by
/// `change` within it: h^2 / 12 * change, the error bound of the rule.
double TrapezoidalError(double gap, double change) { return gap * gap / 12.0 * change; }

bool IsFused(Pipeline pipeline) { return pipeline == Pipeline::kFusion; }

}  // namespace

const Trust& TrustByMode::Of(MapMode mode, Pipeline pipeline) const {
  const bool both = mode == MapMode::kLidarAndCamera;
  switch (pipeline) {
    case Pipeline::kFusion:
      break;
    case Pipeline::kLidar:
      return both ? lidar_beside_camera : lidar_only;
    case Pipeline::kCamera:
      return both ? camera_beside_lidar : camera_only;
  }
  return fusion;
}

void LocalMapperParams::Validate() const {
  map.Validate();
  for (const Trust& each : {trust.fusion, trust.lidar_only, trust.camera_only,
                            trust.lidar_beside_camera, trust.camera_beside_lidar}) {
    require(each.position_weight > 0.0, "position_weight must be > 0");
    require(each.colour_weight >= 0.0, "colour_weight must be >= 0");
  }
  require(history >= 0.5, "history must be >= 0.5 s");
  require(velocity_deadline > 0.0, "velocity_deadline must be > 0");
  require(max_velocity_gap >= velocity_deadline, "max_velocity_gap must be >= velocity_deadline");
  require(gap_acceleration >= 0.0, "gap_acceleration must be >= 0");
  require(gap_yaw_acceleration >= 0.0, "gap_yaw_acceleration must be >= 0");
  require(max_speed > 0.0, "max_speed must be > 0");
  require(max_yaw_rate > 0.0, "max_yaw_rate must be > 0");
  require(cycle > 0.0, "cycle must be > 0");
  require(max_observations > 0, "max_observations must be > 0");
}

LocalMapper::LocalMapper(const LocalMapperParams& params)
    : params_((params.Validate(), params)), history_(params.history), map_(params.map) {}

std::string_view LocalMapper::AddVelocity(int64_t utime, const Twist2& velocity) {
  const bool absurd = !(std::hypot(velocity.vx, velocity.vy) <= params_.max_speed) ||
                      !(std::abs(velocity.yaw_rate) <= params_.max_yaw_rate);
  if (absurd) return "velocity out of range";
  if (history_.empty()) whole_since_utime_ = utime;
  const double gap = history_.empty() ? 0.0 : SecondsBetween(history_.newest_utime(), utime);
  if (gap > params_.max_velocity_gap) {
    Restart();
    whole_since_utime_ = utime;
  }
  if (!history_.Add(utime, velocity)) return "time does not increase";
  velocity_ = velocity;
  if (gap > params_.velocity_deadline && gap <= params_.max_velocity_gap) {
    whole_since_utime_ = utime;
    const double position_error = TrapezoidalError(gap, params_.gap_acceleration);
    const double yaw_error = TrapezoidalError(gap, params_.gap_yaw_acceleration);
    map_.AddMotionUncertainty(T_local_odometry_ * *history_.At(utime),
                              position_error * position_error, yaw_error * yaw_error);
    hidden_variance_ +=
        Eigen::Vector3d(position_error, position_error, yaw_error).cwiseAbs2().eval();
  }
  return {};
}

void LocalMapper::Restart() {
  history_ = PoseHistory(params_.history);
  map_ = LocalMap(params_.map);
  epoch_ = 0;
  T_local_odometry_ = {};
  refined_utime_ = 0;
  hidden_variance_.setZero();
}

/// Dead reckoning and, for a set newer than all before, what its cones say beyond it.
Pose2 LocalMapper::PoseOf(const ObservationSet& set) {
  const Pose2 T_odometry_base = *history_.At(set.utime);
  const PoseRefinementParams& params = params_.map.refinement;
  const Pose2 predicted = T_local_odometry_ * T_odometry_base;
  const Trust& trust = params_.trust.Of(mode_, set.pipeline);
  if (!trust.refines_pose || set.utime <= refined_utime_) return predicted;
  Pose2 pose = predicted;
  if (refined_utime_ > 0) {
    const Twist2 change{velocity_.vx - refined_velocity_.vx, velocity_.vy - refined_velocity_.vy,
                        velocity_.yaw_rate - refined_velocity_.yaw_rate};
    Eigen::Matrix3d covariance =
        MotionCovariance(params, SecondsBetween(refined_utime_, set.utime), change);
    covariance.diagonal() += hidden_variance_;
    pose = map_.Refine(set, predicted, covariance, trust);
  }
  T_local_odometry_ = pose * T_odometry_base.Inverse();
  refined_utime_ = set.utime;
  refined_velocity_ = velocity_;
  hidden_variance_.setZero();
  return pose;
}

LocalMapper::Outcome LocalMapper::Observe(const ObservationSet& set) {
  if (!Uses(mode_, set.pipeline)) return {};
  const std::string_view why = WhyRefused(set);
  if (!why.empty()) return {std::nullopt, why};
  const Pose2 T_local_base = PoseOf(set);
  if (epoch_ == 0) epoch_ = set.utime;
  std::set<int64_t>& used = used_utimes_[static_cast<size_t>(set.pipeline)];
  used.insert(set.utime);
  const int64_t oldest_utime = AddSeconds(history_.newest_utime(), -params_.history);
  used.erase(used.begin(), used.lower_bound(oldest_utime));
  map_.Update(set, T_local_base, params_.trust.Of(mode_, set.pipeline));
  return {LocalMapEstimate{set.utime, epoch_, mode_, T_local_base, map_.Cones()}, {}};
}

std::string_view LocalMapper::WhyRefused(const ObservationSet& set) const {
  if (set.cones.size() > params_.max_observations) return "too many cones";
  if (history_.empty()) return "no velocity yet";
  if (!history_.At(set.utime)) {
    const bool late = set.utime < history_.newest_utime();
    return late ? "later than the pose history" : "ahead of the newest velocity";
  }
  if (set.utime < whole_since_utime_) return "before a gap in the velocity";
  if (used_utimes_[static_cast<size_t>(set.pipeline)].contains(set.utime)) return "seen before";
  if (SharesScan(set)) return "its scan was used already";
  return {};
}

bool LocalMapper::SharesScan(const ObservationSet& set) const {
  for (const Pipeline other : {Pipeline::kFusion, Pipeline::kLidar, Pipeline::kCamera}) {
    if (IsFused(other) == IsFused(set.pipeline)) continue;
    const auto& used = used_utimes_[static_cast<size_t>(other)];
    // A fused set and a single one belong to different scans only if half a cycle or more lies
    // between them.
    if (!used.empty() && SecondsBetween(*used.rbegin(), set.utime) < 0.5 * params_.cycle)
      return true;
  }
  return false;
}

}  // namespace hairpin
