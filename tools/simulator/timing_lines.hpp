#pragma once

#include <Eigen/Core>
#include <optional>

#include "tools/simulator/track.hpp"

namespace hairpin {

/// Where laps begin and end, by the rules: the start line's first crossing begins the first lap,
/// each further one ends a lap and begins the next; on an open track the finish line ends it. A
/// line that was crossed backward has to be crossed forward again before it counts.
class TimingLines {
 public:
  explicit TimingLines(const Track& track);

  /// Share of the way from `before` to `after` (map [m]) at which a lap begins or ends; empty where
  /// none does.
  std::optional<double> Cross(const Eigen::Vector2d& before, const Eigen::Vector2d& after);
  /// Laps ended.
  int laps() const { return laps_; }

 private:
  bool closed_;
  GateLine start_line_;
  GateLine finish_line_;
  bool has_begun_ = false;
  int laps_ = 0;
  int starts_ = 0;  // crossings of the start line, forward less backward
  int most_starts_ = 0;
};

}  // namespace hairpin
