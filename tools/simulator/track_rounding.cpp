#include "tools/simulator/track_rounding.hpp"

#include <algorithm>
#include <cmath>

namespace hairpin {

double TurnAt(const TrackOutline& outline, size_t corner) {
  const Polyline& corners = outline.corners;
  const Eigen::Vector2d& before = corners[(corner + corners.size() - 1) % corners.size()];
  return TurnBetween(corners[corner] - before, SegmentEnd(corners, corner) - corners[corner]);
}

double EdgeLength(const TrackOutline& outline, size_t corner) {
  return (SegmentEnd(outline.corners, corner) - outline.corners[corner]).norm();
}

std::optional<RoundedLine> RoundedLine::Make(const TrackOutline& outline,
                                             const std::vector<double>& radii) {
  const size_t n = outline.corners.size();
  // What an arc takes of either edge: R tan(turn / 2).
  const auto taken = [&](size_t i) {
    return radii[i] * std::tan(0.5 * std::abs(TurnAt(outline, i)));
  };
  RoundedLine line;
  for (size_t k = 0; k < n; ++k) {
    const size_t i = (outline.start_edge + k) % n;
    const size_t j = (i + 1) % n;
    const double straight = EdgeLength(outline, i) - taken(i) - taken(j);
    if (straight < 0.0) return std::nullopt;
    const Eigen::Vector2d along = (outline.corners[j] - outline.corners[i]).normalized();
    const double yaw = std::atan2(along.y(), along.x());
    const Eigen::Vector2d begin = outline.corners[i] + taken(i) * along;
    line.pieces_.push_back({line.length_, straight, {begin.x(), begin.y(), yaw}, 0.0});
    line.length_ += straight;
    const double turn = TurnAt(outline, j);
    const Eigen::Vector2d bend = begin + straight * along;
    line.pieces_.push_back({line.length_,
                            radii[j] * std::abs(turn),
                            {bend.x(), bend.y(), yaw},
                            std::copysign(1.0 / radii[j], turn)});
    line.length_ += line.pieces_.back().length;
  }
  return line;
}

double RoundedLine::Wrapped(double station) const {
  return station - length_ * std::floor(station / length_);
}

const RoundedLine::Piece& RoundedLine::PieceAt(double wrapped) const {
  const auto after =
      std::upper_bound(pieces_.begin(), pieces_.end(), wrapped,
                       [](double value, const Piece& piece) { return value < piece.station; });
  return *std::prev(after);
}

Pose2 RoundedLine::At(double station) const {
  const double wrapped = Wrapped(station);
  const Piece& piece = PieceAt(wrapped);
  return piece.begin * Integrate({1.0, 0.0, piece.curvature}, wrapped - piece.station);
}

double RoundedLine::Curvature(double station) const { return PieceAt(Wrapped(station)).curvature; }

}  // namespace hairpin
