#include "daemons/global_mapper/landmark_table.hpp"

#include <algorithm>
#include <set>

namespace hairpin {

ConeColour LandmarkInfo::colour() const {
  const auto distribution = Normalised(colour_sum);
  return distribution ? MostProbable(*distribution) : ConeColour::kUnknown;
}

void LandmarkTable::Follow(const LocalMapInput& map) {
  if (map.epoch != epoch_) of_local_.clear();
  epoch_ = map.epoch;
  std::set<int64_t> present;
  for (const LocalMapCone& cone : map.cones) present.insert(cone.id);
  std::erase_if(of_local_, [&](const auto& entry) { return !present.contains(entry.first); });
}

std::optional<int64_t> LandmarkTable::Find(int64_t local_id) const {
  const auto found = of_local_.find(local_id);
  if (found == of_local_.end()) return std::nullopt;
  return found->second.landmark;
}

bool LandmarkTable::IsTaken(int64_t landmark) const {
  return std::any_of(of_local_.begin(), of_local_.end(),
                     [&](const auto& entry) { return entry.second.landmark == landmark; });
}

int LandmarkTable::Counted(int64_t local_id) const {
  const auto found = of_local_.find(local_id);
  return found == of_local_.end() ? 0 : found->second.num_observations;
}

void LandmarkTable::Add(const KeyframeRecord& keyframe, double odometer, int bridged) {
  if (keyframe.epoch != epoch_) of_local_.clear();
  epoch_ = keyframe.epoch;
  for (const SightingRecord& sighting : keyframe.sightings) {
    const auto index = static_cast<size_t>(sighting.landmark);
    if (index >= landmarks_.size()) {
      landmarks_.resize(index + 1);
      landmarks_[index].first_seen = odometer;
    }
    LandmarkInfo& landmark = landmarks_[index];
    for (size_t i = 0; i < sighting.colour.size(); ++i)
      landmark.colour_sum[i] += sighting.colour[i];
    landmark.num_observations += sighting.num_observations;
    landmark.num_sightings += std::clamp(sighting.num_observations, 1, bridged);
    landmark.last_seen = odometer;
    of_local_[sighting.local_id] = {sighting.landmark, sighting.local_observations};
  }
}

void LandmarkTable::Merge(int64_t landmark, int64_t into) {
  LandmarkInfo& from = landmarks_.at(static_cast<size_t>(landmark));
  LandmarkInfo& to = landmarks_.at(static_cast<size_t>(into));
  for (size_t i = 0; i < to.colour_sum.size(); ++i) to.colour_sum[i] += from.colour_sum[i];
  to.num_observations += from.num_observations;
  to.num_sightings += from.num_sightings;
  to.first_seen = std::min(to.first_seen, from.first_seen);
  to.last_seen = std::max(to.last_seen, from.last_seen);
  from.alive = false;
  for (auto& [local_id, association] : of_local_) {
    if (association.landmark == landmark) association.landmark = into;
  }
}

void LandmarkTable::Remove(int64_t landmark) {
  landmarks_.at(static_cast<size_t>(landmark)).alive = false;
  std::erase_if(of_local_, [&](const auto& entry) { return entry.second.landmark == landmark; });
}

}  // namespace hairpin
