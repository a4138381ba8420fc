#pragma once

#include <optional>
#include <vector>

#include "common/geometry.hpp"
#include "tools/simulator/track_outline.hpp"

namespace hairpin {

/// A closed line of straights and arcs, by its station: metres from where it began, any number of
/// times round.
class RoundedLine {
 public:
  /// The outline with corner i rounded at radii[i]. Station 0 is where the start edge's straight
  /// begins. Empty where the arcs of two corners would overlap.
  static std::optional<RoundedLine> Make(const TrackOutline& outline,
                                         const std::vector<double>& radii);

  double length() const { return length_; }
  /// Of the straight that begins at station 0.
  double start_straight() const { return pieces_.front().length; }
  /// Position and direction of travel.
  Pose2 At(double station) const;
  /// 1/m, positive to the left.
  double Curvature(double station) const;

 private:
  struct Piece {
    double station;
    double length;
    Pose2 begin;
    double curvature;
  };
  double Wrapped(double station) const;
  const Piece& PieceAt(double wrapped) const;
  std::vector<Piece> pieces_;
  double length_ = 0.0;
};

/// How much the outline turns at corner i, counter-clockwise [rad].
double TurnAt(const TrackOutline& outline, size_t corner);

/// Length of the edge from corner i to the next.
double EdgeLength(const TrackOutline& outline, size_t corner);

}  // namespace hairpin
