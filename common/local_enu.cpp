#include "common/local_enu.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>
#include <stdexcept>

namespace hairpin {

bool IsPlaceOnEarth(const GeodeticPoint& point) {
  return std::abs(point.latitude_deg) <= 90.0 && std::abs(point.longitude_deg) <= 180.0 &&
         std::isfinite(point.height_m);
}

LocalEnu::LocalEnu(const GeodeticPoint& origin) : origin_(origin) {
  if (!IsPlaceOnEarth(origin))
    throw std::invalid_argument("LocalEnu: the origin is no place on Earth");
  plane_ = std::make_unique<GeographicLib::LocalCartesian>(origin.latitude_deg,
                                                           origin.longitude_deg, origin.height_m);
}

LocalEnu::~LocalEnu() = default;
LocalEnu::LocalEnu(LocalEnu&&) noexcept = default;
LocalEnu& LocalEnu::operator=(LocalEnu&&) noexcept = default;

Eigen::Vector3d LocalEnu::ToEnu(const GeodeticPoint& point) const {
  Eigen::Vector3d enu;
  plane_->Forward(point.latitude_deg, point.longitude_deg, point.height_m, enu.x(), enu.y(),
                  enu.z());
  return enu;
}

GeodeticPoint LocalEnu::ToGeodetic(const Eigen::Vector3d& enu) const {
  GeodeticPoint point;
  plane_->Reverse(enu.x(), enu.y(), enu.z(), point.latitude_deg, point.longitude_deg,
                  point.height_m);
  return point;
}

}  // namespace hairpin
