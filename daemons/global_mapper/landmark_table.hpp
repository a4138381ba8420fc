#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "daemons/global_mapper/map_estimate.hpp"
#include "daemons/global_mapper/map_record.hpp"

namespace hairpin {

/// What is known of a landmark besides its place; distances are the car's odometer [m].
struct LandmarkInfo {
  bool alive = true;
  ColourDistribution colour_sum{};
  int num_observations = 0;
  int num_sightings = 0;  // keyframes
  double first_seen = 0.0;
  double last_seen = 0.0;
  Eigen::Matrix2d drift =
      Eigen::Matrix2d::Zero();  // covariance of the pose that first saw it, there

  /// The most probable class of what was observed.
  ConeColour colour() const;
};

/// Which landmark each local cone is, as long as both live, and what each landmark looked like.
class LandmarkTable {
 public:
  std::vector<LandmarkInfo>& landmarks() { return landmarks_; }
  const std::vector<LandmarkInfo>& landmarks() const { return landmarks_; }

  /// Forgets which local cone is which where the epoch has changed, and those that are not in the
  /// map.
  void Follow(const LocalMapInput& map);
  std::optional<int64_t> Find(int64_t local_id) const;
  /// True if a local cone of the present map is this landmark.
  bool IsTaken(int64_t landmark) const;
  /// Observations of a local cone that are counted already.
  int Counted(int64_t local_id) const;

  /// `bridged`: keyframes that would have fitted in since the one before, at least 1. A cone counts
  /// as seen by as many of them as it has new observations.
  void Add(const KeyframeRecord& keyframe, double odometer, int bridged);
  void Merge(int64_t landmark, int64_t into);
  void Remove(int64_t landmark);

 private:
  struct Association {
    int64_t landmark = 0;
    int num_observations = 0;
  };
  int64_t epoch_ = 0;
  std::map<int64_t, Association> of_local_;  // by local id
  std::vector<LandmarkInfo> landmarks_;
};

}  // namespace hairpin
