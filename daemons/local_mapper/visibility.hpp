#pragma once

#include <Eigen/Core>
#include <vector>

#include "daemons/local_mapper/observation.hpp"

namespace hairpin {

/// Recall by range [m], measured against truth, linear between its points. Outside them it is
/// unknown, and taken as 0: then a miss proves nothing.
struct RecallByRange {
  std::vector<double> range;   // rising, at least two
  std::vector<double> recall;  // as many, 0 to 1

  double At(double cone_range) const;
  /// Throws std::invalid_argument, `name` in front.
  void Validate(const std::string& name) const;
};

struct VisibilityParams {
  double bearing_margin =
      0.0;  // rad, >= 0: nearer than this to the edge of view, a miss proves nothing
  double range_margin = 0.0;          // m, >= 0
  double occlusion_half_width = 0.0;  // m, > 0: half the shadow of a cone
};

/// True if `cone` (base [m]) is inside the sectors, with the margins around it inside as well.
/// Where two sectors meet or overlap there is no edge.
bool InView(const std::vector<ViewSector>& sectors, const Eigen::Vector2d& cone,
            const VisibilityParams& params);

/// True if one of `cones` (base [m]) is nearer than `cone` and less than half a shadow off the line
/// of sight to it.
bool IsHidden(const Eigen::Vector2d& cone, const std::vector<Eigen::Vector2d>& cones,
              const VisibilityParams& params);

}  // namespace hairpin
