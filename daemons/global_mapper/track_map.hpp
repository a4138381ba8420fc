#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "daemons/global_mapper/constellation.hpp"
#include "daemons/global_mapper/landmark_table.hpp"
#include "daemons/global_mapper/map_estimate.hpp"
#include "daemons/global_mapper/map_record.hpp"
#include "daemons/global_mapper/odometry.hpp"
#include "daemons/global_mapper/pose_landmark_graph.hpp"

namespace hairpin {

inline constexpr double kCrowded = 0.4;  // m: no two cones stand nearer, whatever their colours

struct LoopParams {
  ConstellationParams constellation;
  ConstellationParams gap;        // across a gap of the odometry
  double min_distance = 0.0;      // m driven before a loop is looked for, > 0
  double recent_distance = 0.0;   // m driven: landmarks first seen since may be old ones, > 0
  double search_radius = 0.0;     // m from the car within which old landmarks are looked at, > 0
  double gate_chi2 = 0.0;         // of the correction, by the covariance of the motion since, > 0;
                                  // beyond it the shape must say it alone:
  size_t min_pairs_by_shape = 0;  // >= constellation.min_pairs
  double max_rmse = 0.0;          // m, of the merged landmarks' sightings after the solve, > 0
  double same_cone = 0.0;         // m: nearer landmarks that were never seen together are one, > 0
};

/// Poses that a keyframe marginalises at most: the lap that was mapped before the loop closed is
/// soon caught up with, and no keyframe pays for it.
inline constexpr int kMarginalisedAtOnce = 5;

struct TrackMapParams {
  GraphParams graph;
  ConeFilter filter;
  double keyframe_distance = 0.0;   // m, > 0
  double keyframe_angle = 0.0;      // rad, > 0
  size_t max_keyframes = 0;         // more are marginalised, > graph.window_poses
  size_t max_open_keyframes = 0;    // the same until the loop is closed, >= max_keyframes
  size_t full_solve_keyframes = 0;  // between solves of everything once the loop is closed, > 0
  size_t max_landmarks = 0;         // > 0
  int min_sightings = 0;  // keyframes that must have seen a cone before it is published, > 0
  double covariance_inflation =
      0.0;                        // of a local cone's covariance, since filtered means repeat, >= 1
  double cone_sigma = 0.0;        // m, > 0: what no covariance models
  double association_gate = 0.0;  // m, > 0
  double memory_distance = 0.0;   // m driven since last seen within which the gate is enough, > 0
  LoopParams loop;

  /// Throws std::invalid_argument naming parameter, relation and bound.
  void Validate() const;
};

/// The map that is being made: keyframes and landmarks in a pose-landmark graph, data association,
/// loop closure. [paper III-C, global map]
///
/// Made of MapRecords only. Observe() makes them; Replay() takes them, and is left with the same
/// map.
class TrackMap {
 public:
  explicit TrackMap(const TrackMapParams& params);

  struct Step {
    std::vector<MapRecord> records;  // what happened, in order
    bool solved = true;              // false: the solver failed, the map stands as before
  };
  /// Adds a keyframe. `motion`: since the keyframe before; the first one's is not used. `whole`:
  /// with every cone that the local map is certain of, near or far, seen now or before.
  Step Observe(const LocalMapInput& map, const Motion& motion, bool whole = false);
  /// True if a motion is so uncertain that the association gate means nothing after it.
  bool IsGap(const Eigen::Matrix3d& covariance) const;
  /// Does what Observe() did when it made the record, so that the map comes out the same.
  void Replay(const MapRecord& record);

  bool empty() const { return !last_.has_value(); }
  /// Newest keyframe; only where not empty.
  const KeyframeRecord& last() const { return *last_; }
  /// True if a map that is so far from the last keyframe is to become one: where a whole number of
  /// keyframe distances is passed, so that who misses one takes the same ones from then on.
  bool IsKeyframe(const Pose2& T_last_base) const;
  Pose2 last_pose() const { return graph_.newest_pose(); }
  const Eigen::Matrix3d& last_covariance() const { return covariance_; }
  bool loop_closed() const { return closed_; }
  /// False for the two keyframes after a merge, in which what it changed is solved for.
  bool settled() const { return settles_in_ == 0; }
  double odometer() const { return odometer_; }
  /// Every cone seen often enough, by rising id.
  std::vector<GlobalCone> Cones() const;
  const PoseLandmarkGraph& graph() const { return graph_; }
  /// Where the car was since this odometer reading: positions of keyframes in driving order, no
  /// more than the newest `max_open_keyframes` of those that left the graph.
  std::vector<Eigen::Vector2d> DrivenSince(double odometer) const;

 private:
  struct Passed {
    Eigen::Vector2d position;
    double odometer;
  };
  void BoundGraph();
  /// A motion across which landmarks are not known again but by their shape: of two epochs of the
  /// local map with too little between them.
  struct Gap {
    size_t first_landmark = 0;  // of those seen since
    size_t pose = 0;            // number of the first one after it
    double odometer = 0.0;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  // of the motion, map
  };
  void NoteGap(const KeyframeRecord& keyframe);
  std::vector<SightingRecord> Associate(const LocalMapInput& map, const Pose2& T_map_base,
                                        bool whole) const;
  struct Candidate;
  std::vector<Candidate> Candidates(const std::vector<const LocalMapCone*>& cones,
                                    const Pose2& T_map_local) const;
  SightingRecord ToSighting(const LocalMapCone& cone, const Pose2& T_local_base,
                            int64_t landmark) const;
  void Apply(const KeyframeRecord& keyframe);
  void Apply(const MergeRecord& merge);
  void Apply(const RemovalRecord& removal);
  void SharpenCovariance(const KeyframeRecord& keyframe);
  bool SolveAfterKeyframe();
  void Settle();
  std::optional<RemovalRecord> FindPhantoms(int64_t utime) const;
  std::optional<MergeRecord> FindDoubles(int64_t utime) const;
  std::optional<MergeRecord> FindLoop(int64_t utime) const;
  std::vector<int64_t> Landmarks(bool recent) const;
  std::vector<ConstellationPoint> Points(const std::vector<int64_t>& landmarks) const;
  bool IsExplained(const std::vector<int64_t>& recent, const ConstellationMatch& match) const;
  double CorrectionChi2(const Pose2& correction, const Pose2& pose,
                        const Eigen::Matrix3d& covariance) const;
  std::optional<MergeRecord> FindAcrossGap(int64_t utime, bool last_chance) const;
  bool IsBackAtTheStart(const Pose2& correction) const;
  bool ClosesLoop(const MergeRecord& merge, const Pose2& correction) const;
  bool FitsAfterSolve(const MergeRecord& merge) const;
  void TryToClose(bool last_chance, Step& step);
  bool TryToMerge(const MergeRecord& merge, Step& step);
  bool SolveMerged(const MergeRecord& merge);

  TrackMapParams params_;
  PoseLandmarkGraph graph_;
  LandmarkTable table_;
  std::optional<KeyframeRecord> last_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();  // of the newest pose, map
  std::vector<Eigen::Matrix2d> covariances_;              // of landmarks, at the last full solve
  double odometer_ = 0.0;
  std::deque<double> odometers_;  // at each pose of the graph
  std::deque<Passed> passed_;     // poses that left it
  std::optional<Gap> gap_;
  bool closed_ = false;
  size_t keyframes_since_full_ = 0;
  int settles_in_ = 0;  // keyframes
};

}  // namespace hairpin
