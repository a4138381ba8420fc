#include "daemons/local_mapper/visibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/geometry.hpp"
#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr Require require("local_mapper");

bool Covers(const ViewSector& sector, double bearing, double range) {
  const double centre = 0.5 * (sector.min_bearing + sector.max_bearing);
  const double half_width = 0.5 * (sector.max_bearing - sector.min_bearing);
  return range <= sector.max_range && std::abs(WrapAngle(bearing - centre)) <= half_width;
}

}  // namespace

double RecallByRange::At(double cone_range) const {
  if (cone_range < range.front() || cone_range > range.back()) return 0.0;
  const auto above = std::upper_bound(range.begin(), range.end(), cone_range);
  if (above == range.end()) return recall.back();
  const auto i = static_cast<size_t>(above - range.begin());
  const double share = (cone_range - range[i - 1]) / (range[i] - range[i - 1]);
  return recall[i - 1] + share * (recall[i] - recall[i - 1]);
}

void RecallByRange::Validate(const std::string& name) const {
  require(range.size() >= 2, name + " ranges must be >= 2 in number");
  require(range.size() == recall.size(), name + " recalls must be as many as its ranges");
  const auto not_rising = std::adjacent_find(range.begin(), range.end(), std::greater_equal<>());
  require(not_rising == range.end() && range.front() >= 0.0,
          name + " ranges must rise from >= 0 m");
  for (const double value : recall) {
    require(value >= 0.0 && value <= 1.0, name + " recalls must be in [0, 1]");
  }
}

bool InView(const std::vector<ViewSector>& sectors, const Eigen::Vector2d& cone,
            const VisibilityParams& params) {
  const double bearing = std::atan2(cone.y(), cone.x());
  const double range = cone.norm() + params.range_margin;
  const std::array<double, 3> bearings{bearing - params.bearing_margin, bearing,
                                       bearing + params.bearing_margin};
  return std::all_of(bearings.begin(), bearings.end(), [&](double b) {
    return std::any_of(sectors.begin(), sectors.end(),
                       [&](const ViewSector& sector) { return Covers(sector, b, range); });
  });
}

bool IsHidden(const Eigen::Vector2d& cone, const std::vector<Eigen::Vector2d>& cones,
              const VisibilityParams& params) {
  const double range = cone.norm();
  return std::any_of(cones.begin(), cones.end(), [&](const Eigen::Vector2d& other) {
    const double along = other.dot(cone) / range;
    const double across = std::abs(cone.x() * other.y() - cone.y() * other.x()) / range;
    return along > 0.0 && along < range - params.occlusion_half_width &&
           across < params.occlusion_half_width;
  });
}

}  // namespace hairpin
