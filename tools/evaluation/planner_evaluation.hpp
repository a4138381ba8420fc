#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "tools/evaluation/recorded_track.hpp"

namespace hairpin {

/// How the boundary estimator did on one frame of a recording. Metres along the path or the driven
/// line.
struct PlannerFrame {
  TrackEstimate estimate;
  double seen_length =
      0.0;  // of the stretch ahead that cones of the frame's map line, up to the full length
  bool crosses = false;           // a boundary of the final map within the full length
  bool crosses_observed = false;  // within the seen stretch
  double time_ms = 0.0;
};

struct PlannerReport {
  std::vector<PlannerFrame> frames;
  static constexpr double kFullLength = 15.0;  // m [paper IV]
};

/// Plans on every frame of the run with one estimator, in order, and judges each path by the whole
/// recording.
PlannerReport EvaluatePlanner(const std::vector<RecordedFrame>& run,
                              const BoundaryEstimatorParams& params);

/// The figures of a report. Percentages are of all frames; frames without a path reach nothing and
/// cross nothing.
nlohmann::json ToJson(const PlannerReport& report);

}  // namespace hairpin
