#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "daemons/global_mapper/track_map.hpp"

namespace hairpin {
namespace {

constexpr double kMinExplained =
    0.7;                           // share of the cones in known country that must be known ones
constexpr double kPairOdds = 3.0;  // logarithm of the odds that one more pair is worth
// Drift is distributed as Student's t with this freedom: near its covariance as a Gaussian, but a
// wheel that slips or a biased gyro makes more of it than any covariance told.
constexpr double kDriftFreedom = 4.0;
constexpr Eigen::Index kPoseSize = 3;
constexpr size_t kMaxAfterGap = 25;      // cones since a gap that are looked for before it
constexpr size_t kMinConstellation = 3;  // two cones fit anywhere
constexpr double kLastChance = 0.4;      // of memory_distance driven since a gap

/// How improbable a drift is, in pairs: less the logarithm of its density against that of none.
double DriftPenalty(double chi2) {
  return 0.5 * (kDriftFreedom + static_cast<double>(kPoseSize)) * std::log1p(chi2 / kDriftFreedom) /
         kPairOdds;
}

}  // namespace

/// Those first seen lately, or those near the car not seen for long; by rising number.
std::vector<int64_t> TrackMap::Landmarks(bool recent) const {
  std::vector<int64_t> chosen;
  const auto& landmarks = table_.landmarks();
  for (size_t l = 0; l < landmarks.size(); ++l) {
    const LandmarkInfo& info = landmarks[l];
    if (!info.alive || info.num_sightings < params_.min_sightings) continue;
    const bool is_recent = info.first_seen > odometer_ - params_.loop.recent_distance;
    const bool is_old =
        info.last_seen < odometer_ - params_.memory_distance &&
        (graph_.landmark(l) - last_pose().position()).norm() <= params_.loop.search_radius;
    if (recent ? is_recent : is_old) chosen.push_back(static_cast<int64_t>(l));
  }
  return chosen;
}

std::vector<ConstellationPoint> TrackMap::Points(const std::vector<int64_t>& landmarks) const {
  std::vector<ConstellationPoint> points;
  for (const int64_t l : landmarks) {
    const auto index = static_cast<size_t>(l);
    points.push_back({graph_.landmark(index), table_.landmarks()[index].colour()});
  }
  return points;
}

/// From the first cone on that is an old one, the car is in known country: most must be.
bool TrackMap::IsExplained(const std::vector<int64_t>& recent,
                           const ConstellationMatch& match) const {
  size_t first = recent.size();
  for (const auto& pair : match.pairs) first = std::min(first, pair.first);
  const auto in_known_country = static_cast<double>(recent.size() - first);
  return static_cast<double>(match.pairs.size()) >= kMinExplained * in_known_country;
}

/// Of a correction of a pose with this covariance.
double TrackMap::CorrectionChi2(const Pose2& correction, const Pose2& pose,
                                const Eigen::Matrix3d& motion) const {
  const Pose2 corrected = correction * pose;
  Eigen::Matrix<double, kPoseSize, 1> shift;
  shift << corrected.x - pose.x, corrected.y - pose.y, correction.yaw;
  const double tolerance = params_.loop.constellation.tolerance;
  Eigen::Matrix3d covariance = motion;
  covariance.topLeftCorner<2, 2>() += tolerance * tolerance * Eigen::Matrix2d::Identity();
  covariance(2, 2) += std::pow(tolerance / params_.filter.max_range, 2);
  return shift.dot(covariance.ldlt().solve(shift));
}

/// Only there the loop is closed; elsewhere two stretches of the track come near each other.
bool TrackMap::IsBackAtTheStart(const Pose2& correction) const {
  return (correction * last_pose()).position().norm() <= params_.loop.search_radius;
}

std::optional<MergeRecord> TrackMap::FindLoop(int64_t utime) const {
  const std::vector<int64_t> recent = Landmarks(true);
  const std::vector<int64_t> old = Landmarks(false);
  // By the covariance of the motion since the start: an upper bound of that since the old cones
  // were seen.
  const auto chi2 = [this](const Pose2& T) { return CorrectionChi2(T, last_pose(), covariance_); };
  const auto match = MatchConstellation(Points(recent), Points(old), {}, params_.loop.constellation,
                                        [&](const Pose2& T) { return DriftPenalty(chi2(T)); });
  if (!match || !IsExplained(recent, *match)) return std::nullopt;
  const bool by_shape = chi2(match->T_to_from) > params_.loop.gate_chi2;
  if (by_shape && match->pairs.size() < params_.loop.min_pairs_by_shape) return std::nullopt;
  const bool loop = IsBackAtTheStart(match->T_to_from);
  if (by_shape && !loop) return std::nullopt;
  MergeRecord merge{utime, loop, by_shape, {}};
  for (const auto& [from, to] : match->pairs) merge.pairs.emplace_back(recent[from], old[to]);
  return merge;
}

/// The cones seen since the gap among those seen before it, the nearest ones of each. At the last
/// chance a few that fit will do: without them nothing but a guess is left.
std::optional<MergeRecord> TrackMap::FindAcrossGap(int64_t utime, bool last_chance) const {
  const Pose2 after = graph_.pose(std::max(gap_->pose, graph_.first_pose()));
  std::vector<int64_t> recent;
  std::vector<int64_t> old;
  const auto distance = [&](int64_t l) {
    return (graph_.landmark(static_cast<size_t>(l)) - after.position()).norm();
  };
  for (size_t i = 0; i < table_.landmarks().size(); ++i) {
    const auto l = static_cast<int64_t>(i);
    if (table_.landmarks()[i].alive && distance(l) <= params_.loop.search_radius)
      (i >= gap_->first_landmark ? recent : old).push_back(l);
  }
  for (std::vector<int64_t>* landmarks : {&recent, &old}) {
    std::stable_sort(landmarks->begin(), landmarks->end(),
                     [&](int64_t x, int64_t y) { return distance(x) < distance(y); });
  }
  recent.resize(std::min(recent.size(), kMaxAfterGap));
  ConstellationParams params = params_.loop.gap;
  if (last_chance) {
    params.min_pairs = kMinConstellation;
    params.min_lead = 1;
  }
  const auto match = MatchConstellation(
      Points(recent), Points(old), {}, params,
      [&](const Pose2& T) { return DriftPenalty(CorrectionChi2(T, after, gap_->covariance)); });
  if (!match) return std::nullopt;
  MergeRecord merge{utime, false, true, {}};
  for (const auto& [from, to] : match->pairs) merge.pairs.emplace_back(recent[from], old[to]);
  merge.loop = ClosesLoop(merge, match->T_to_from);
  return merge;
}

/// True if a gap is left at the start: enough of the cones were not seen for long.
bool TrackMap::ClosesLoop(const MergeRecord& merge, const Pose2& correction) const {
  if (closed_ || odometer_ < params_.loop.min_distance) return false;
  const auto old = std::count_if(merge.pairs.begin(), merge.pairs.end(), [this](const auto& pair) {
    const LandmarkInfo& info = table_.landmarks().at(static_cast<size_t>(pair.second));
    return info.last_seen < gap_->odometer - params_.memory_distance;
  });
  return static_cast<size_t>(old) >= params_.loop.constellation.min_pairs &&
         IsBackAtTheStart(correction);
}

bool TrackMap::FitsAfterSolve(const MergeRecord& merge) const {
  double sum = 0.0;
  for (const auto& [landmark, into] : merge.pairs) {
    const auto rms = graph_.SightingRms(static_cast<size_t>(into), graph_.first_pose());
    sum += rms ? *rms * *rms : 0.0;
  }
  return std::sqrt(sum / static_cast<double>(merge.pairs.size())) <= params_.loop.max_rmse;
}

/// Landmarks that stand in one place and were never seen side by side, or stand nearer than cones
/// do.
std::optional<MergeRecord> TrackMap::FindDoubles(int64_t utime) const {
  MergeRecord merge{utime, false, false, {}};
  std::vector<bool> gone(table_.landmarks().size(), false);
  for (size_t a = 0; a < gone.size(); ++a) {
    for (size_t b = a + 1; b < gone.size(); ++b) {
      const auto& landmarks = table_.landmarks();
      if (gone[a] || gone[b] || !landmarks[a].alive || !landmarks[b].alive) continue;
      const double distance = (graph_.landmark(a) - graph_.landmark(b)).norm();
      if (distance > params_.loop.same_cone) continue;
      const bool may_be_two = !AreCompatible(landmarks[a].colour(), landmarks[b].colour()) ||
                              graph_.MayHaveBeenSeenTogether(a, b);
      if (may_be_two && distance > kCrowded) continue;
      gone[b] = true;
      merge.pairs.emplace_back(static_cast<int64_t>(b), static_cast<int64_t>(a));
    }
  }
  if (merge.pairs.empty()) return std::nullopt;
  return merge;
}

bool TrackMap::SolveMerged(const MergeRecord& merge) {
  // From where drift has led, a robust loss would take the true sightings for outliers.
  if (merge.by_shape && !graph_.SolveAllTrustingSightings()) return false;
  return graph_.SolveAll();
}

void TrackMap::TryToClose(bool last_chance, Step& step) {
  if (gap_) {
    last_chance = last_chance || odometer_ - gap_->odometer > kLastChance * params_.memory_distance;
    if (const auto merge = FindAcrossGap(last_->utime, last_chance)) TryToMerge(*merge, step);
    return;
  }
  if (closed_ || odometer_ < params_.loop.min_distance) return;
  if (const auto loop = FindLoop(last_->utime)) TryToMerge(*loop, step);
}

bool TrackMap::TryToMerge(const MergeRecord& merge, Step& step) {
  const TrackMap before = *this;
  Apply(merge);
  const bool solved = SolveMerged(merge);
  if (!solved || !FitsAfterSolve(merge)) {
    *this = before;
    step.solved = step.solved && solved;
    return false;
  }
  step.records.emplace_back(merge);
  if (const auto doubles = FindDoubles(last_->utime)) {
    Apply(*doubles);
    step.records.emplace_back(*doubles);
  }
  last_->T_map_base = last_pose();
  return true;
}

}  // namespace hairpin
