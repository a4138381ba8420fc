#pragma once

#include <vector>

#include "tools/evaluation/polyline.hpp"
#include "tools/evaluation/recorded_run.hpp"

namespace hairpin {

/// What a whole recording tells about the track, to judge single frames of it by. In its map frame,
/// metres.
class RecordedTrack {
 public:
  /// Throws RecordingError for a run without frames.
  explicit RecordedTrack(const std::vector<RecordedFrame>& run);

  /// The line driven from frame `frame` on, at least `length` long where the run holds it; past the
  /// recording's end it goes on with the lap before.
  Polyline DrivenAhead(size_t frame, double length) const;

  /// Length of the driven line ahead of `frame`, up to `max_length`, to the first point without a
  /// yellow or without a blue cone of that frame's map within `kSeenRadius`. Orange and unknown
  /// cones count as both.
  double SeenLength(const std::vector<RecordedFrame>& run, size_t frame, double max_length) const;

  /// Segments between consecutive cones of a side in the final map.
  const std::vector<Segment>& boundaries() const { return boundaries_; }

  static constexpr double kSeenRadius = 4.5;     // m
  static constexpr double kSampleSpacing = 0.1;  // m, along the driven line
  static constexpr double kMinLap = 50.0;    // m; a shorter way back to the same place is no lap
  static constexpr double kSamePlace = 4.0;  // m, between the lines of two laps
  static constexpr double kMaxConeDistance =
      5.0;                                 // m; farther from the driven line a cone bounds nothing
  static constexpr double kMaxGap = 10.0;  // m; a wider gap of a side is left open

 private:
  void FindLapBefore();
  void ChainBoundaries(const std::vector<MapCone>& final_map);

  Polyline driven_;
  std::vector<double> along_;  // m driven at each frame
  // The frame of the lap before where the recording's end was passed; driven_.size() where there
  // was none.
  size_t lap_before_ = 0;
  std::vector<Segment> boundaries_;
};

}  // namespace hairpin
