#include "tools/evaluation/recorded_track.hpp"

#include <algorithm>
#include <map>

namespace hairpin {

RecordedTrack::RecordedTrack(const std::vector<RecordedFrame>& run) {
  if (run.empty()) throw RecordingError("a run without frames");
  for (const RecordedFrame& frame : run) {
    const Eigen::Vector2d position = frame.T_map_base.position();
    along_.push_back(driven_.empty() ? 0.0 : along_.back() + (position - driven_.back()).norm());
    driven_.push_back(position);
  }
  FindLapBefore();
  ChainBoundaries(run.back().cones);
}

void RecordedTrack::FindLapBefore() {
  const Eigen::Vector2d end = driven_.back();
  const auto distance = [&](size_t i) { return (driven_[i] - end).norm(); };
  lap_before_ = driven_.size();
  for (size_t i = driven_.size(); i-- > 0;) {
    if (along_.back() - along_[i] < kMinLap) continue;
    const bool passed = lap_before_ < driven_.size();
    if (passed && distance(i) > kSamePlace) break;
    if (distance(i) <= kSamePlace && (!passed || distance(i) < distance(lap_before_)))
      lap_before_ = i;
  }
}

Polyline RecordedTrack::DrivenAhead(size_t frame, double length) const {
  Polyline line{driven_[frame]};
  double done = 0.0;
  size_t next = frame + 1;
  while (done < length) {
    if (next == driven_.size()) {
      if (lap_before_ == driven_.size()) break;
      next = lap_before_ + 1;
    }
    done += (driven_[next] - line.back()).norm();
    line.push_back(driven_[next++]);
  }
  return line;
}

double RecordedTrack::SeenLength(const std::vector<RecordedFrame>& run, size_t frame,
                                 double max_length) const {
  const Polyline line = DrivenAhead(frame, max_length);
  const double end = std::min(Length(line), max_length);
  const auto sees = [&](const Eigen::Vector2d& point, ConeColour colour) {
    return std::any_of(run[frame].cones.begin(), run[frame].cones.end(), [&](const MapCone& cone) {
      const ConeColour other =
          colour == ConeColour::kBlue ? ConeColour::kYellow : ConeColour::kBlue;
      return MostProbable(cone.colour) != other && (cone.position - point).norm() <= kSeenRadius;
    });
  };
  for (double along = 0.0; along < end; along += kSampleSpacing) {
    const Eigen::Vector2d point = PointAt(line, along);
    if (!sees(point, ConeColour::kBlue) || !sees(point, ConeColour::kYellow)) return along;
  }
  return end;
}

void RecordedTrack::ChainBoundaries(const std::vector<MapCone>& final_map) {
  // One lap of the driven line orders the cones of each side; orange ones belong to the side they
  // stand on.
  const bool closed = lap_before_ < driven_.size();
  const Polyline lap(driven_.begin() + static_cast<std::ptrdiff_t>(closed ? lap_before_ : 0),
                     driven_.end());
  std::multimap<double, Eigen::Vector2d> sides[2];
  for (const MapCone& cone : final_map) {
    const Projection projection = Project(cone.position, lap);
    if (projection.distance > kMaxConeDistance) continue;
    const ConeColour colour = MostProbable(cone.colour);
    const Eigen::Vector2d behind = PointAt(lap, projection.along - kSampleSpacing);
    const Eigen::Vector2d forward = PointAt(lap, projection.along + kSampleSpacing) - behind;
    const Eigen::Vector2d offset = cone.position - behind;
    const bool stands_left = forward.x() * offset.y() - forward.y() * offset.x() > 0.0;
    const bool left = colour == ConeColour::kBlue || (colour != ConeColour::kYellow && stands_left);
    sides[left ? 0 : 1].emplace(projection.along, cone.position);
  }
  for (const auto& side : sides) {
    Polyline chain;
    for (const auto& [along, position] : side) chain.push_back(position);
    if (closed && chain.size() > 2) chain.push_back(chain.front());
    for (size_t i = 1; i < chain.size(); ++i) {
      if ((chain[i] - chain[i - 1]).norm() <= kMaxGap)
        boundaries_.push_back({chain[i - 1], chain[i]});
    }
  }
}

}  // namespace hairpin
