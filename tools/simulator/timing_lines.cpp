#include "tools/simulator/timing_lines.hpp"

#include "tools/simulator/track_area.hpp"

namespace hairpin {

TimingLines::TimingLines(const Track& track)
    : closed_(track.closed), start_line_(track.start_line), finish_line_(track.finish_line) {}

std::optional<double> TimingLines::Cross(const Eigen::Vector2d& before,
                                         const Eigen::Vector2d& after) {
  const GateCrossing start = CrossGate(start_line_, before, after);
  starts_ += start.direction;
  const bool starts = starts_ > most_starts_;
  if (starts) most_starts_ = starts_;
  if (!has_begun_) {
    has_begun_ = starts;
    return starts ? std::optional(start.share) : std::nullopt;
  }
  const GateCrossing finish = CrossGate(finish_line_, before, after);
  const bool ends = closed_ ? starts : finish.direction > 0;
  if (!ends) return std::nullopt;
  ++laps_;
  return finish.share;
}

}  // namespace hairpin
