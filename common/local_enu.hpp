#pragma once

#include <Eigen/Core>
#include <memory>

namespace GeographicLib {
class LocalCartesian;
}

namespace hairpin {

/// On the WGS 84 ellipsoid.
struct GeodeticPoint {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double height_m = 0.0;  // above the ellipsoid
};

/// True for a latitude within 90 and a longitude within 180 degrees, and a finite height.
bool IsPlaceOnEarth(const GeodeticPoint& point);

/// The tangent plane at an origin: x east, y north, z up [m]. Source: GeographicLib,
/// LocalCartesian, exact to nanometres.
class LocalEnu {
 public:
  /// Throws std::invalid_argument for an origin that is no place on Earth.
  explicit LocalEnu(const GeodeticPoint& origin);
  ~LocalEnu();
  LocalEnu(LocalEnu&&) noexcept;
  LocalEnu& operator=(LocalEnu&&) noexcept;

  const GeodeticPoint& origin() const { return origin_; }
  Eigen::Vector3d ToEnu(const GeodeticPoint& point) const;
  GeodeticPoint ToGeodetic(const Eigen::Vector3d& enu) const;

 private:
  GeodeticPoint origin_;
  std::unique_ptr<GeographicLib::LocalCartesian> plane_;
};

}  // namespace hairpin
