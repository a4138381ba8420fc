#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "daemons/global_mapper/track_map.hpp"

namespace hairpin {
namespace {

/// Enough to be looked at across a gap, where few cones are seen from both sides: what is left
/// alone there is dropped once passed.
bool IsBelieved(const LocalMapCone& cone) { return cone.existence > 0.5; }

}  // namespace

/// A local cone that is no landmark yet, and one that it may be.
struct TrackMap::Candidate {
  double distance = 0.0;
  size_t cone = 0;
  int64_t landmark = 0;

  bool operator<(const Candidate& other) const {
    return std::tie(distance, cone, landmark) <
           std::tie(other.distance, other.cone, other.landmark);
  }
};

/// Pairs within the gate. A landmark that was last seen so long ago that drift may exceed the gate
/// is left to the loop closure, unless the loop is closed; one from before a gap, until that is
/// bridged.
std::vector<TrackMap::Candidate> TrackMap::Candidates(const std::vector<const LocalMapCone*>& cones,
                                                      const Pose2& T_map_local) const {
  std::vector<Candidate> candidates;
  const auto& landmarks = table_.landmarks();
  for (size_t l = 0; l < landmarks.size(); ++l) {
    if (!landmarks[l].alive || table_.IsTaken(static_cast<int64_t>(l))) continue;
    if (gap_ && l < gap_->first_landmark) continue;
    if (!closed_ && odometer_ - landmarks[l].last_seen > params_.memory_distance) continue;
    for (size_t c = 0; c < cones.size(); ++c) {
      const double distance = (T_map_local * cones[c]->position - graph_.landmark(l)).norm();
      if (distance > params_.association_gate) continue;
      if (!AreCompatible(MostProbable(cones[c]->colour), landmarks[l].colour()) &&
          distance > kCrowded)
        continue;
      candidates.push_back({distance, c, static_cast<int64_t>(l)});
    }
  }
  std::sort(candidates.begin(), candidates.end());
  return candidates;
}

std::vector<SightingRecord> TrackMap::Associate(const LocalMapInput& map, const Pose2& T_map_base,
                                                bool whole) const {
  const Pose2 T_map_local = T_map_base * map.T_local_base.Inverse();
  std::vector<std::pair<const LocalMapCone*, int64_t>> sightings;
  std::vector<const LocalMapCone*> open;
  for (const LocalMapCone& cone : map.cones) {
    const bool far_too = ((whole || gap_) && IsBelieved(cone)) ||
                         (cone.seen_meanwhile && params_.filter.IsCertain(cone));
    if (!far_too && !params_.filter.Accepts(cone, map.T_local_base)) continue;
    if (const auto landmark = table_.Find(cone.id)) {
      sightings.emplace_back(&cone, *landmark);
    } else {
      open.push_back(&cone);
    }
  }
  std::set<int64_t> taken;
  std::vector<bool> done(open.size(), false);
  for (const Candidate& candidate : Candidates(open, T_map_local)) {
    if (done[candidate.cone] || !taken.insert(candidate.landmark).second) continue;
    done[candidate.cone] = true;
    sightings.emplace_back(open[candidate.cone], candidate.landmark);
  }
  auto next = static_cast<int64_t>(graph_.num_landmarks());
  for (size_t c = 0; c < open.size(); ++c) {
    if (done[c] || next >= static_cast<int64_t>(params_.max_landmarks)) continue;
    const bool crowded = std::any_of(sightings.begin(), sightings.end(), [&](const auto& sighting) {
      return (sighting.first->position - open[c]->position).norm() < kCrowded;
    });
    if (!crowded) sightings.emplace_back(open[c], next++);
  }
  std::vector<SightingRecord> records;
  records.reserve(sightings.size());
  for (const auto& [cone, landmark] : sightings)
    records.push_back(ToSighting(*cone, map.T_local_base, landmark));
  return records;
}

SightingRecord TrackMap::ToSighting(const LocalMapCone& cone, const Pose2& T_local_base,
                                    int64_t landmark) const {
  SightingRecord record;
  record.landmark = landmark;
  record.local_id = cone.id;
  record.position = T_local_base.Inverse() * cone.position;
  record.covariance =
      params_.covariance_inflation * RotateCovariance(cone.covariance, -T_local_base.yaw) +
      params_.cone_sigma * params_.cone_sigma * Eigen::Matrix2d::Identity();
  record.num_observations = std::max(0, cone.num_observations - table_.Counted(cone.id));
  record.local_observations = cone.num_observations;
  for (size_t i = 0; i < record.colour.size(); ++i)
    record.colour[i] = record.num_observations * cone.colour[i];
  return record;
}

std::optional<RemovalRecord> TrackMap::FindPhantoms(int64_t utime) const {
  RemovalRecord removal{utime, {}};
  const auto& landmarks = table_.landmarks();
  for (size_t l = 0; l < landmarks.size(); ++l) {
    const LandmarkInfo& info = landmarks[l];
    const bool passed = odometer_ - info.last_seen > 2.0 * params_.filter.max_range;
    if (info.alive && passed && info.num_sightings < params_.min_sightings)
      removal.landmarks.push_back(static_cast<int64_t>(l));
  }
  if (removal.landmarks.empty()) return std::nullopt;
  return removal;
}

}  // namespace hairpin
