#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "hairpin/cones_t.hpp"
#include "tools/simulator/piecewise_linear.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/track.hpp"

namespace hairpin {

/// The character of one perception pipeline. Functions are of the range from base [m].
struct ConeSensorParams {
  double half_field_of_view_rad = 0.0;
  double max_range_m = 0.0;
  double phase_s = 0.0;                     // of its period, against the other pipelines
  PiecewiseLinear recall{0.0};              // probability that a cone in view is reported
  PiecewiseLinear radial_noise_m{0.0};      // sigma along the line of sight
  PiecewiseLinear tangential_noise_m{0.0};  // sigma across it
  PiecewiseLinear colour_correct{0.0};      // probability of the right colour
  PiecewiseLinear colour_wrong{0.0};  // of the other side's colour; what is left to 1 is "unknown"
  bool sees_orange = false;           // else orange cones are "unknown"
  PiecewiseLinear false_positives_per_m{0.0};  // in a scan, per metre of range
  double clutter_probability =
      0.0;  // that a thing beside the track, in view and recalled, looks like a cone
  double phantom_unknown_probability = 0.0;  // that what is no cone gets no colour either
};

/// A detection pipeline at the level of cones: what of the world a scan reports, and how wrongly.
/// The covariances and colour probabilities that it states are those of the errors that it makes.
class ConeSensor {
 public:
  /// `name` keeps its random stream apart from the others'. Throws std::invalid_argument for values
  /// that cannot be.
  ConeSensor(const ConeSensorParams& params, const std::string& name, uint64_t seed);

  /// One scan at `utime` from `T_map_base`, of cones and clutter in map; positions reported in
  /// base.
  cones_t Scan(int64_t utime, const Pose2& T_map_base, const std::vector<TrackCone>& cones,
               const std::vector<Eigen::Vector2d>& clutter);

  const ConeSensorParams& params() const { return params_; }

 private:
  bool InView(const Eigen::Vector2d& position_base) const;
  cone_observation_t Observe(const Eigen::Vector2d& position_base,
                             const ColourDistribution& colour);
  void AddFalsePositives(std::vector<cone_observation_t>& observations);
  ColourDistribution Classify(ConeColour colour, double range);
  ColourDistribution ClassifyPhantom(double range);

  ConeSensorParams params_;
  RandomStream random_;
};

}  // namespace hairpin
