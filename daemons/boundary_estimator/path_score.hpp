#pragma once

#include <Eigen/Core>
#include <array>

#include "common/cone.hpp"

namespace hairpin {

/// The features F_1 to F_6 of a middle path [paper III-D]: largest angle change [rad], standard
/// deviations of the distance between left cones, between right cones and of the track width [m],
/// edges crossed, length [m].
inline constexpr size_t kNumFeatures = 6;
using FeatureValues = std::array<double, kNumFeatures>;

struct PathScoreParams {
  double prior_weight = 0.0;     // W_prior
  FeatureValues weight{};        // W_j
  FeatureValues setpoint{};      // S_j; of edges and length also the limit that F_j is cut off at
  FeatureValues normaliser{};    // N_j, in the feature's unit squared
  double min_probability = 0.0;  // colour probabilities are kept within [min, 1 - min]
  double min_spacing =
      0.0;  // m; cones of a side nearer than this are one mark, as at the start gate
  double min_segment =
      0.0;  // m; angle changes are taken between parts of the path at least this long
};

/// Why a path wins or loses.
struct PathScore {
  FeatureValues term{};         // W_j (F_j - S_j)^2 / N_j
  double log_prior = 0.0;       // -W_prior * sum of terms
  double log_likelihood = 0.0;  // sum over the boundary cones of log p_assigned - log p_max
  double log_posterior() const { return log_prior + log_likelihood; }
};

/// Throws std::invalid_argument naming the parameter, the relation and the bound.
void Check(const PathScoreParams& params);

/// log p_assigned - log p_max of one cone, on the left and on the right boundary. Never positive.
struct SideLogRatios {
  double left = 0.0;
  double right = 0.0;
};

/// Left cones are blue or unknown, right cones yellow or unknown, whichever is more probable;
/// orange may stand on either side, as unknown. Cones off the boundary have their most probable
/// class, so that in the product over all cones only these ratios differ from path to path [paper
/// III-D, likelihood].
SideLogRatios ToSideLogRatios(const ColourDistribution& colour, double min_probability);

/// Distance of `point` from the segment [m].
double DistanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                         const Eigen::Vector2d& to);

/// The features of a path that grows edge by edge, in constant time and memory for each edge.
class PathFeatures {
 public:
  PathFeatures() = default;
  /// A path that starts at `start` towards `direction` (unit vector).
  PathFeatures(const Eigen::Vector2d& start, const Eigen::Vector2d& direction)
      : end_(start), anchor_(start), direction_(direction) {}

  void AddLeftSpacing(double distance) { left_.Add(distance); }
  void AddRightSpacing(double distance) { right_.Add(distance); }
  /// Width of the track where one side went on from cone to cone: the distance of the other side's
  /// cone from that stretch.
  void AddWidth(double width) { width_.Add(width); }
  /// Crosses an edge at its midpoint.
  void Cross(const Eigen::Vector2d& midpoint, double min_segment);

  /// F_1 to F_6, not cut off.
  FeatureValues values() const;
  double length() const { return length_; }
  int edges() const { return edges_; }
  /// Of the largest angle change.
  double least_cosine() const { return least_cosine_; }
  const Eigen::Vector2d& end() const { return end_; }

 private:
  /// Mean and sum of squared differences (Welford).
  struct Deviation {
    int count = 0;
    double mean = 0.0;
    double squares = 0.0;
    void Add(double value);
    double value() const;
  };

  Eigen::Vector2d end_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d anchor_ = Eigen::Vector2d::Zero();  // where the current part of the path begins
  Eigen::Vector2d direction_ = Eigen::Vector2d::UnitX();  // of the part before it
  double least_cosine_ = 1.0;
  double length_ = 0.0;
  int edges_ = 0;
  Deviation left_;
  Deviation right_;
  Deviation width_;
};

/// The log posterior, term by term.
PathScore Score(const FeatureValues& features, double log_likelihood,
                const PathScoreParams& params);

}  // namespace hairpin
