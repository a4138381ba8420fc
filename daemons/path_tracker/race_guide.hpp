#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "daemons/path_tracker/reference_path.hpp"
#include "daemons/path_tracker/speed_profile.hpp"

namespace hairpin {

struct RaceGuideParams {
  ReferencePathParams path;
  SpeedProfileParams speed;
  double body_width = 0.0;          // [m], > 0
  double max_age = 0.0;             // of a line that is followed [s], > 0
  double max_position_sigma = 0.0;  // of the localisation [m], > 0
  double max_yaw_sigma = 0.0;       // [rad], > 0
  double max_jump = 0.0;            // sideways, from one line to the next at the car [m], > 0
  double overlap = 0.0;             // of the car with a boundary that TRACK sees [m], >= 0
  double checked_length = 0.0;      // of the line, against TRACK [m], > 0
  double healthy_for = 0.0;         // until a line is followed [s], >= 0
  double blend_time = 0.0;          // from one guide to the other [s], > 0
};

/// A race line as it arrives: in map, with the pose that the localisation had.
struct RaceLineInput {
  int64_t utime = 0;
  Pose2 T_map_base;                     // at utime
  double position_sigma = 0.0;          // the worst direction's [m]
  double yaw_sigma = 0.0;               // [rad]
  std::vector<Eigen::Vector2d> points;  // map [m], evenly spaced, from a little behind the car on
  std::vector<double> speeds;           // as many [m/s]
};

/// What TRACK says of the way ahead, in the tracker's own frame.
struct SeenTrack {
  int64_t utime = 0;
  const ReferencePath* path = nullptr;
  std::vector<Eigen::Vector2d> points;  // of its part that cones support [m]
  std::vector<double> widths;           // of the track there [m]
};

/// Holds the line to race on and decides whether it is followed.
///
/// A line is healthy while it is young, the localisation is sure of itself, the line has not jumped
/// sideways, and a car on its next metres stays between the boundaries that TRACK sees, with a
/// TRACK that is young itself. After `healthy_for` seconds of health the line's weight rises from 0
/// to 1 within `blend_time`; at the first doubt it falls back as fast. Meanwhile the last good line
/// is kept, in the tracker's dead-reckoned frame, so that the reference moves over without a step.
class RaceGuide {
 public:
  /// Throws std::invalid_argument for parameters out of their bounds.
  explicit RaceGuide(const RaceGuideParams& params);

  /// Takes a line; `T_own_base` is where the tracker was at its time, `T_own_now` where it is.
  /// Returns why it was refused, empty if taken: not newer than the last one, fewer than two
  /// points, or without length. A line in doubt is no refusal: it ends the following.
  std::string Take(const RaceLineInput& input, const Pose2& T_own_base, const Pose2& T_own_now);
  /// Judges the line by a new TRACK.
  void Compare(const SeenTrack& track);
  /// Time is `utime`, the car at `T_own_base`; `track_utime` is the age of the path to fall back
  /// on.
  void Update(int64_t utime, const Pose2& T_own_base, std::optional<int64_t> track_utime);

  /// 0: TRACK alone, 1: the race line alone.
  double weight() const;
  /// The line alone guides, its speeds too.
  bool leads() const { return weight_ >= 1.0; }
  /// Where there is no doubt; the speeds of the line then bound the car also while it moves over.
  bool healthy() const { return healthy_since_.has_value(); }
  int64_t line_utime() const { return line_ ? line_->utime : 0; }

  /// Where a point is on the line, near the car. Only while weight() > 0, as the next.
  ReferencePath::Location Locate(const Eigen::Vector2d& point_own) const;
  /// Speed at `ahead` [m] of the car's place.
  SpeedProfile::Limit Speed(double ahead) const;

 private:
  struct Line {
    int64_t utime;
    ReferencePath path;
    SpeedProfile profile;
    double progress;  // arc length of base [m]
  };
  bool Jumps(const Line& line, const Pose2& T_own_now) const;
  bool KeepsBetweenBoundaries(const SeenTrack& track) const;

  RaceGuideParams params_;
  std::optional<Line> line_;
  int64_t taken_utime_ = 0;  // of the newest line heard
  bool sure_ = false;        // the newest line's localisation, and no jump
  bool between_ = false;     // by the newest TRACK
  double weight_ = 0.0;
  int64_t last_utime_ = 0;
  std::optional<int64_t> healthy_since_;
};

}  // namespace hairpin
