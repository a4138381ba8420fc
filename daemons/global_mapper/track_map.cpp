#include "daemons/global_mapper/track_map.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr Require require("global_mapper");

constexpr int kSettlesIn = 2;  // keyframes

Eigen::Matrix2d PointCovariance(const Eigen::Matrix3d& pose, const Eigen::Vector2d& lever) {
  Eigen::Matrix<double, 2, 3> J = Eigen::Matrix<double, 2, 3>::Zero();
  J.leftCols<2>().setIdentity();
  J(0, 2) = -lever.y();
  J(1, 2) = lever.x();
  return J * pose * J.transpose();
}

/// Of the pose after a motion, both in map.
Eigen::Matrix3d Propagate(const Eigen::Matrix3d& covariance, const Pose2& T_map_from,
                          const Motion& motion) {
  const Eigen::Vector2d step = T_map_from.rotation() * motion.T_from_to.position();
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 2) = -step.y();
  F(1, 2) = step.x();
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G.topLeftCorner<2, 2>() = T_map_from.rotation();
  return F * covariance * F.transpose() + G * motion.covariance * G.transpose();
}

}  // namespace

void TrackMapParams::Validate() const {
  graph.Validate();
  require(filter.max_range > 0.0, "max_range must be > 0");
  require(filter.min_existence >= 0.0 && filter.min_existence <= 1.0,
          "min_existence must be in [0, 1]");
  require(filter.min_observations >= 1, "min_observations must be >= 1");
  require(keyframe_distance > 0.0, "keyframe_distance must be > 0");
  require(keyframe_angle > 0.0, "keyframe_angle must be > 0");
  require(max_keyframes > graph.window_poses, "max_keyframes must be > window_poses");
  require(max_open_keyframes >= max_keyframes, "max_open_keyframes must be >= max_keyframes");
  require(full_solve_keyframes > 0, "full_solve_keyframes must be > 0");
  require(max_landmarks > 0, "max_landmarks must be > 0");
  require(min_sightings > 0, "min_sightings must be > 0");
  require(covariance_inflation >= 1.0, "covariance_inflation must be >= 1");
  require(cone_sigma > 0.0, "cone_sigma must be > 0");
  require(association_gate > 0.0, "association_gate must be > 0");
  require(memory_distance > 0.0, "memory_distance must be > 0");
  loop.constellation.Validate();
  loop.gap.Validate();
  require(loop.min_pairs_by_shape >= loop.constellation.min_pairs,
          "loop min_pairs_by_shape must be >= min_pairs");
  require(loop.min_distance > 0.0, "loop min_distance must be > 0");
  require(loop.recent_distance > 0.0, "loop recent_distance must be > 0");
  require(loop.search_radius > 0.0, "loop search_radius must be > 0");
  require(loop.gate_chi2 > 0.0, "loop gate_chi2 must be > 0");
  require(loop.max_rmse > 0.0, "loop max_rmse must be > 0");
  require(loop.same_cone > 0.0, "loop same_cone must be > 0");
}

TrackMap::TrackMap(const TrackMapParams& params) : params_(params), graph_(params.graph) {
  params.Validate();
}

bool TrackMap::IsKeyframe(const Pose2& T_last_base) const {
  const double travelled = odometer_ + T_last_base.position().norm();
  return std::floor(travelled / params_.keyframe_distance) >
             std::floor(odometer_ / params_.keyframe_distance) ||
         std::abs(T_last_base.yaw) >= params_.keyframe_angle;
}

bool TrackMap::IsGap(const Eigen::Matrix3d& covariance) const {
  const double tolerated = params_.association_gate / 3.0;
  const double turned = params_.filter.max_range * params_.filter.max_range * covariance(2, 2);
  return covariance.topLeftCorner<2, 2>().trace() + turned > tolerated * tolerated;
}

void TrackMap::NoteGap(const KeyframeRecord& keyframe) {
  if (empty() || keyframe.epoch == last_->epoch || !IsGap(keyframe.covariance)) return;
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G.topLeftCorner<2, 2>() = last_pose().rotation();
  gap_ = Gap{graph_.num_landmarks(), graph_.end_pose(), odometer_,
             G * keyframe.covariance * G.transpose()};
}

TrackMap::Step TrackMap::Observe(const LocalMapInput& map, const Motion& motion, bool whole) {
  KeyframeRecord keyframe{map.utime,         map.epoch, map.T_local_base, {}, motion.T_from_to,
                          motion.covariance, {}};
  if (!empty()) keyframe.T_map_base = last_pose() * motion.T_from_to;
  NoteGap(keyframe);
  table_.Follow(map);
  keyframe.sightings = Associate(map, keyframe.T_map_base, whole);
  Apply(keyframe);
  Step step;
  step.solved = SolveAfterKeyframe();
  keyframe.T_map_base = last_pose();
  last_ = keyframe;
  step.records.emplace_back(keyframe);
  if (const auto removal = FindPhantoms(map.utime)) {
    Apply(*removal);
    step.records.emplace_back(*removal);
  }
  // A whole map is the last one before the next gap.
  if (settled() || whole) TryToClose(whole, step);
  return step;
}

void TrackMap::Replay(const MapRecord& record) {
  if (const auto* keyframe = std::get_if<KeyframeRecord>(&record)) {
    NoteGap(*keyframe);
    Apply(*keyframe);
    SolveAfterKeyframe();
    last_->T_map_base = last_pose();
  } else if (const auto* merge = std::get_if<MergeRecord>(&record)) {
    const bool doubles = settles_in_ == kSettlesIn;  // found with the merge just before
    Apply(*merge);
    if (!doubles) SolveMerged(*merge);
  } else if (const auto* removal = std::get_if<RemovalRecord>(&record)) {
    Apply(*removal);
  }
}

/// What a merge leaves to do is spread over the keyframes that follow: a solve of everything with
/// the first, now that none is double, and covariances before the second.
void TrackMap::Settle() {
  if (settled() || --settles_in_ > 0) return;
  covariances_ = graph_.LandmarkCovariances();
}

void TrackMap::Apply(const KeyframeRecord& keyframe) {
  Settle();
  const Motion motion{keyframe.T_before_base, keyframe.covariance};
  double driven = 0.0;
  if (!empty()) {
    covariance_ = Propagate(covariance_, last_pose(), motion);
    graph_.AddPose({motion.T_from_to, SqrtInformation(motion.covariance)});
    driven = motion.T_from_to.position().norm();
    odometer_ += driven;
  }
  const Pose2 T_map_base = last_pose();
  for (const SightingRecord& sighting : keyframe.sightings) {
    const bool is_new = static_cast<size_t>(sighting.landmark) == graph_.num_landmarks();
    if (is_new) graph_.AddLandmark(keyframe.T_map_base * sighting.position);
    graph_.AddSighting(static_cast<size_t>(sighting.landmark),
                       {sighting.position, SqrtInformation(sighting.covariance)});
    if (!is_new) continue;
    covariances_.resize(graph_.num_landmarks(), Eigen::Matrix2d::Zero());
    covariances_.back() = PointCovariance(covariance_, T_map_base.rotation() * sighting.position) +
                          RotateCovariance(sighting.covariance, T_map_base.yaw);
  }
  table_.Add(keyframe, odometer_,
             std::max(1, static_cast<int>(driven / params_.keyframe_distance)));
  if (gap_ && odometer_ - gap_->odometer > params_.memory_distance) gap_.reset();
  last_ = keyframe;
  if (closed_) SharpenCovariance(keyframe);
  odometers_.push_back(odometer_);
  BoundGraph();
}

/// What leaves the graph stays linearised where it stands: not before a merge is solved for.
void TrackMap::BoundGraph() {
  if (!settled()) return;
  const size_t bound = closed_ ? params_.max_keyframes : params_.max_open_keyframes;
  for (int i = 0; i < kMarginalisedAtOnce && graph_.num_poses() > bound; ++i) {
    passed_.push_back({graph_.pose(graph_.first_pose()).position(), odometers_.front()});
    if (passed_.size() > params_.max_open_keyframes) passed_.pop_front();
    graph_.MarginaliseOldest();
    odometers_.pop_front();
  }
}

std::vector<Eigen::Vector2d> TrackMap::DrivenSince(double odometer) const {
  std::vector<Eigen::Vector2d> driven;
  for (const Passed& passed : passed_) {
    if (passed.odometer >= odometer) driven.push_back(passed.position);
  }
  for (size_t i = 0; i < odometers_.size(); ++i) {
    if (odometers_[i] >= odometer)
      driven.push_back(graph_.pose(graph_.first_pose() + i).position());
  }
  return driven;
}

/// What the sightings of a known map say of the pose: an information update, landmarks being as
/// uncertain as the last full solve left them.
void TrackMap::SharpenCovariance(const KeyframeRecord& keyframe) {
  Eigen::Matrix3d information = covariance_.inverse();
  const double yaw = keyframe.T_map_base.yaw;
  for (const SightingRecord& sighting : keyframe.sightings) {
    const Eigen::Vector2d lever = Pose2{0.0, 0.0, yaw} * sighting.position;
    Eigen::Matrix<double, 2, 3> J = Eigen::Matrix<double, 2, 3>::Zero();
    J.leftCols<2>().setIdentity();
    J(0, 2) = -lever.y();
    J(1, 2) = lever.x();
    const Eigen::Matrix2d noise = RotateCovariance(sighting.covariance, yaw) +
                                  covariances_.at(static_cast<size_t>(sighting.landmark));
    information += J.transpose() * noise.inverse() * J;
  }
  covariance_ = information.inverse();
}

void TrackMap::Apply(const MergeRecord& merge) {
  for (const auto& [landmark, into] : merge.pairs) {
    graph_.MergeLandmark(static_cast<size_t>(landmark), static_cast<size_t>(into));
    table_.Merge(landmark, into);
  }
  closed_ = closed_ || merge.loop;
  settles_in_ = kSettlesIn;
  keyframes_since_full_ = 0;
  if (merge.by_shape) gap_.reset();
}

void TrackMap::Apply(const RemovalRecord& removal) {
  for (const int64_t landmark : removal.landmarks) {
    graph_.RemoveLandmark(static_cast<size_t>(landmark));
    table_.Remove(landmark);
  }
}

bool TrackMap::SolveAfterKeyframe() {
  const bool due = closed_ && ++keyframes_since_full_ >= params_.full_solve_keyframes;
  if (!due && settles_in_ != kSettlesIn - 1) return graph_.SolveWindow();
  keyframes_since_full_ = 0;
  return graph_.SolveAll();
}

std::vector<GlobalCone> TrackMap::Cones() const {
  std::vector<GlobalCone> cones;
  const auto& landmarks = table_.landmarks();
  for (size_t i = 0; i < landmarks.size(); ++i) {
    const LandmarkInfo& info = landmarks[i];
    if (!info.alive || info.num_sightings < params_.min_sightings) continue;
    // Where it stands is not known as long as nobody knows how the car came there.
    if (gap_ && i >= gap_->first_landmark) continue;
    cones.push_back({static_cast<int64_t>(i), graph_.landmark(i), covariances_[i],
                     Normalised(info.colour_sum).value_or(kColourUnknown), info.num_observations});
  }
  return cones;
}

}  // namespace hairpin
